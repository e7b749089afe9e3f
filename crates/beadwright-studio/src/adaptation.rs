//! What follows a scan of an unfinished build, as `beadwright adapt` finds it: settings, layers, pictures.

use crate::computing::Computing;
use crate::disk;
use crate::view3d::LayerBeads;
use beadwright::adapt::page::Reliefs;
use beadwright::adapt::scan::{self, Scan};
use beadwright::adapt::{AdaptError, Adapted, Align, Rules, Unfinished};
use beadwright::layer::Layer;
use beadwright::metrics::Metrics;
use beadwright::plan::{Header, Summary};
use beadwright::plan_file;
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::weld::Torch;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;

/// A scan, and how the layers after it are corrected.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adaptation {
    /// The file of the scan.
    pub scan: PathBuf,
    /// The layer after which it was taken, from 1.
    pub after_layer: usize,
    /// How it is aligned with the part.
    #[serde(default)]
    pub align: Align,
    /// Least and greatest metal per length, as multiples of what was planned.
    pub window: [f64; 2],
}

impl Adaptation {
    /// A scan taken after a layer, from 1, with the usual limits.
    pub fn of(scan: PathBuf, after_layer: usize) -> Self {
        Self { scan, after_layer, align: Align::AsIs, window: Rules::WINDOW }
    }

    /// What is wrong with settings read from a file, as a sentence.
    pub(crate) fn fault(&self) -> Option<String> {
        if self.after_layer == 0 {
            return Some("adapted.after_layer is counted from 1".to_owned());
        }
        (!Rules::allow(self.window))
            .then(|| "adapted.window is least and most, as [0.7, 1.3]: 0.1 to 1, and 1 to 5".to_owned())
    }

    /// The name of the scan's file.
    pub fn name(&self) -> String {
        self.scan.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }
}

/// The plan that was scanned while it was built.
pub(crate) struct Scanned {
    pub(crate) header: Header,
    pub(crate) layers: Vec<Arc<Layer>>,
    pub(crate) profile: Arc<Profile>,
}

impl Scanned {
    /// Its layers with the decimals of `plan.json`, from which the command adapts: so both write the same bytes.
    fn as_written(&self) -> Result<Vec<Layer>, String> {
        let Self { header, layers, profile } = self;
        if !profile.layers.are_level() {
            return Err(AdaptError::NotLevel.to_string());
        }
        let text = layers.iter().map(|layer| plan_file::layer(layer, None));
        let text: String = std::iter::once(plan_file::head(header, profile)).chain(text).collect();
        let plan = plan_file::read(&(text + plan_file::tail())).map_err(|error| error.to_string())?;
        Ok(plan.layers)
    }
}

/// What follows a scan.
pub struct Follows {
    /// The scan compared with the plan, and the layers that follow.
    pub adapted: Arc<Adapted>,
    /// What was predicted, measured, and the difference.
    pub reliefs: Reliefs,
    /// What all layers have in common.
    pub header: Header,
    /// The totals of all layers.
    pub summary: Summary,
    /// The layers that are welded, as `plan.json` has them.
    pub built: Vec<Arc<Layer>>,
    /// The layers that follow, with their segments to be drawn.
    pub layers: Vec<(Arc<Layer>, Arc<LayerBeads>)>,
    scan: Arc<Scan>,
}

impl Follows {
    /// Reads the scan, unless it was read before, compares it with the plan and corrects what follows.
    ///
    /// # Errors
    /// A sentence on why no layers can follow.
    pub(crate) fn of(
        settings: &Adaptation,
        known: Option<Arc<Scan>>,
        plan: &Scanned,
        task: &Task,
    ) -> Result<Self, String> {
        let scan = match known {
            Some(scan) => scan,
            None => {
                let read = scan::read(&disk::read(&settings.scan)?, task);
                Arc::new(read.map_err(|error| format!("{}: {error}", settings.scan.display()))?)
            }
        };
        let Scanned { header, profile, .. } = plan;
        let mut layers = plan.as_written()?;
        let number = settings.after_layer;
        let build = Unfinished { header, layers: &layers, profile, number };
        let [least, most] = settings.window;
        let rules = Rules { window: (least, most), spacing: profile.bead.width };
        let adapted = Adapted::of(build, (*scan).clone(), settings.align, rules).map_err(|error| error.to_string())?;
        task.check().map_err(|error| error.to_string())?;
        let (mut metrics, mut torch) = (Metrics::new(profile), Torch::of(&profile.weld_settings()));
        let mut follows = Vec::new();
        layers.truncate(number);
        for (k, layer) in layers.iter().chain(&adapted.followed.layers).enumerate() {
            metrics.add(layer);
            // The torch comes from the layers below.
            let beads = LayerBeads::of(layer, &mut torch);
            if k >= number {
                follows.push((Arc::new(layer.clone()), Arc::new(beads)));
            }
        }
        Ok(Self {
            built: layers.into_iter().map(Arc::new).collect(),
            reliefs: Reliefs::of(&adapted.seen),
            header: adapted.header(header),
            summary: adapted.summary(metrics, profile),
            adapted: Arc::new(adapted),
            layers: follows,
            scan,
        })
    }
}

/// A scan being compared, or compared.
pub(crate) struct Adapting {
    pub(crate) settings: Adaptation,
    pub(crate) run: Computing<Follows>,
    /// Whether an error was reported.
    pub(crate) reported: bool,
}

impl Adapting {
    /// The scan, if it is in this file and read.
    pub(crate) fn scan_of(&self, settings: &Adaptation) -> Option<Arc<Scan>> {
        Some(self.run.found().filter(|_| self.settings.scan == settings.scan)?.scan.clone())
    }
}
