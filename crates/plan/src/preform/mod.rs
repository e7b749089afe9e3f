//! From a part to its preform: the part plus the stock that is milled off afterwards.
//!
//! | rule | file |
//! | --- | --- |
//! | stock on all faces, holes to be welded shut, each layer supported by the one below | this one |
//! | at least one bead everywhere, out to the part's own corners, and long enough for a pass | [`wide`] |
//! | what is milled off, weights, hours and prices | [`figures`] |
//! | the orientation in which all of this costs least | [`orient`] |
//! | a closed surface of the result | [`solid`] |
//! | the faces of the part, and how much metal lies over each | [`faces`] |
//! | the keys of a profile | [`section`] |
//!
//! A preform consists of steps, thinner than a layer. From the top down, a step P(k) is the part within it with its
//! stock, G(k), united with the support that the step above needs: that step shrunk by the allowed overhang. Areas too
//! narrow for a bead are then widened to one, and gaps narrower than `fill_holes` closed. In each step the part is
//! taken at its widest, so that no slice of it extends beyond the preform.

pub mod faces;
pub mod figures;
pub mod orient;
pub mod section;
pub mod solid;
pub mod wide;

use bead_part::model::Mesh;
use bead_part::slice::{Slab, SliceOptions, Slicer};
use bead_part::task::{Cancelled, Task};
use planar::offset::ARC_TOLERANCE_MM;
use planar::{Join, Region};
use rayon::prelude::*;

/// How a part becomes its preform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PreformSettings {
    /// Stock on faces that look sideways, mm.
    pub side: f64,
    /// Stock on faces that look up, mm.
    pub top: f64,
    /// Stock on faces that look down, mm.
    pub bottom: f64,
    /// Gaps narrower than this are closed, mm.
    pub fill_holes: f64,
    /// How far a step may overhang the one below, rad from the vertical.
    pub reach: f64,
    /// The plate.
    pub plate: Plate,
    /// Width of a bead, mm; with 0 nothing is widened, as when orientations are compared.
    pub bead_width: f64,
    /// Width with space for two beads side by side, mm.
    pub room: f64,
    /// Thickness of a step, mm.
    pub step: f64,
    /// Length of the shortest pass, mm.
    pub shortest: f64,
    /// Widest gap in the part's outline that is bridged, mm.
    pub close_gap: f64,
    /// Points of the part's outline within this distance of the simplified line are dropped, mm.
    pub simplify: f64,
}

/// What becomes of the plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Plate {
    /// It is sawn off.
    Sawn {
        /// Height above the plate at which the saw cuts, mm.
        cut: f64,
    },
    /// It becomes the lowest part of the part.
    Kept {
        /// Thickness of the plate, mm.
        thickness: f64,
    },
}

impl PreformSettings {
    /// Height of the part's lowest point above the plate, mm; negative if it lies within a plate that is kept.
    pub fn lift(&self) -> f64 {
        match self.plate {
            Plate::Sawn { cut } => cut + self.bottom,
            Plate::Kept { thickness } => self.bottom - thickness,
        }
    }

    /// Arcs are twice as accurate as the part's outlines.
    fn join(&self) -> Join {
        Join::Round((self.simplify / 2.0).max(ARC_TOLERANCE_MM))
    }

    /// How far a step may overhang the one below, mm.
    fn overhang(&self) -> f64 {
        self.step * self.reach.tan()
    }
}

/// A part plus the stock that is milled off afterwards, in steps of one height.
#[derive(Debug, Clone, PartialEq)]
pub struct Preform {
    /// The steps, the lowest first; the preform stands on the plate.
    pub steps: Vec<Region>,
    /// Thickness of a step, mm.
    pub step: f64,
    /// Height of the part's lowest point above the plate, mm.
    pub lift: f64,
}

impl Preform {
    /// The preform of a mesh that stands on z = 0.
    ///
    /// ```
    /// use bead_plan::preform::{Preform, section::PreformSection};
    /// use bead_part::{example, slice::SliceOptions, task::Task};
    ///
    /// // A plate of 120 × 60 × 12 mm or so, and 1.5 mm around it.
    /// let plate = example::find("plate").ok_or("no such example")?.mesh();
    /// // Beads 6 mm wide, two in 9 mm, in layers of 2 mm; passes of at least 10 mm.
    /// let slicing = SliceOptions { layer_height: 2.0, close_gap: 0.1, simplify: 0.01 };
    /// let settings = PreformSection::default().settings([6.0, 9.0], 10.0, slicing);
    /// let preform = Preform::of(&plate, &settings, &Task::new())?;
    /// assert!(preform.volume() > plate.volume());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Cancelled`] if the task was cancelled.
    pub fn of(mesh: &Mesh, settings: &PreformSettings, task: &Task) -> Result<Self, Cancelled> {
        let own = Sections::of(mesh, settings, task)?;
        let mut steps: Vec<Region> = Vec::with_capacity(own.grown.len());
        let mut above = (Region::default(), Region::default());
        for k in (0..own.grown.len()).rev() {
            task.check()?;
            let (grown, bare) = (&own.grown[k], &own.bare[k]);
            // If nothing changes, the step equals the one above.
            let same = own.grown.get(k + 1).is_some_and(|upper| upper == grown) && own.bare.get(k + 1) == Some(bare);
            let step = if same && above.0 == above.1 {
                above.0.clone()
            } else {
                let held = above.0.offset(-settings.overhang(), settings.join());
                let held = grown.union(&held);
                let wide = if settings.bead_width > 0.0 { wide::widened(&held, bare, settings) } else { held };
                let step = closed(&wide, settings.fill_holes, settings.join());
                if settings.bead_width > 0.0 { step } else { step.simplified(settings.simplify) }
            };
            above = (step.clone(), std::mem::replace(&mut above.0, step.clone()));
            steps.push(step);
        }
        steps.reverse();
        // The tip of a spike is not part of any slice.
        while steps.pop_if(|top| top.is_empty()).is_some() {}
        Ok(Self { steps, step: settings.step, lift: settings.lift() })
    }

    /// Volume, mm³.
    pub fn volume(&self) -> f64 {
        self.step * self.steps.iter().map(Region::area).sum::<f64>()
    }

    /// The step at a height above the plate, mm.
    pub fn at(&self, z: f64) -> Option<&Region> {
        let number = (z / self.step).floor();
        (number >= 0.0).then(|| self.steps.get(number as usize)).flatten()
    }
}

/// A region with gaps narrower than `width` (mm) filled: holes, slots and grooves.
fn closed(region: &Region, width: f64, join: Join) -> Region {
    let by = width / 2.0;
    region.offset(by, join).offset(-by, join).union(region)
}

/// What a part needs in each step.
struct Sections {
    /// The part itself, at its widest in the step.
    bare: Vec<Region>,
    /// The part with its stock.
    grown: Vec<Region>,
}

/// Cells per step; the part is cut at both ends of each cell.
const CELLS: usize = 2;
/// A cell is cut this far from its ends, in cells, so that a face there belongs to one side.
const INSIDE: f64 = 1e-3;

impl Sections {
    fn of(mesh: &Mesh, settings: &PreformSettings, task: &Task) -> Result<Self, Cancelled> {
        let (height, lift, cell) = (mesh.size().z, settings.lift(), settings.step / CELLS as f64);
        let count = ((lift + height + settings.top) / settings.step - 1e-6).ceil().max(0.0) as usize;
        let cells = Self::cells(mesh, count * CELLS, settings, task)?;
        // Stock lies above faces that look up, and below those that look down.
        let (up, down) =
            ((settings.top / cell - 1e-6).ceil() as usize, (settings.bottom / cell - 1e-6).ceil() as usize);
        // The saw cuts through the metal on which the part stands.
        let foot = cells.iter().position(|region| !region.is_empty()).unwrap_or(0);
        let of = |k: usize| -> Result<(Region, Region), Cancelled> {
            task.check()?;
            let united = |from: usize, to: usize| {
                let mut parts: Vec<&Region> = cells[from.min(cells.len())..to.min(cells.len())].iter().collect();
                parts.dedup();
                parts.into_iter().fold(Region::default(), |all, part| all.union(part))
            };
            let bare = united(k * CELLS, (k + 1) * CELLS);
            let stock = united((k * CELLS).saturating_sub(up), ((k + 1) * CELLS + down).max(foot + 1));
            Ok((bare, stock.offset(settings.side, settings.join())))
        };
        let steps = (0..count).into_par_iter().map(of).collect::<Result<Vec<_>, _>>()?;
        let (bare, grown) = steps.into_iter().unzip();
        Ok(Self { bare, grown })
    }

    /// The part within each of a number of cells above the plate.
    fn cells(mesh: &Mesh, count: usize, settings: &PreformSettings, task: &Task) -> Result<Vec<Region>, Cancelled> {
        let (height, lift, cell) = (mesh.size().z, settings.lift(), settings.step / CELLS as f64);
        let ends = |k: usize| [k as f64 + INSIDE, (k + 1) as f64 - INSIDE].map(|z| (k, z * cell - lift));
        let cuts: Vec<(usize, f64)> = (0..count).flat_map(ends).filter(|(_, z)| (0.0..height).contains(z)).collect();
        let thin = INSIDE * cell;
        let slabs = cuts.iter().map(|(_, z)| Slab { z: z + thin / 2.0, height: thin }).collect();
        let PreformSettings { close_gap, simplify, .. } = *settings;
        let options = SliceOptions { layer_height: thin, close_gap, simplify };
        let slices = Slicer::of_slabs(mesh, slabs, options, task)?.all(task)?;
        let mut cells = vec![Region::default(); count];
        for ((cell, _), slice) in cuts.into_iter().zip(slices) {
            let own = Region::from_normalised(slice.islands);
            cells[cell] = if cells[cell].is_empty() || cells[cell] == own { own } else { cells[cell].union(&own) };
        }
        Ok(cells)
    }
}
