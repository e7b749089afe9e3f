//! Assembles a drawing from its sections: every entity in place, composites from their members, and a list of what was
//! not read.

use super::cards::{self, Card};
use super::chain::{self, Chain};
use super::directory::{self, Entry};
use super::free_format::{Parameters, Text};
use super::global::{self, Global};
use super::{EntityCount, IgesCurve, IgesError, IgesFile, entities, names};
use crate::curve::Nurbs;
use glam::{DAffine3, DVec3};
use std::collections::{BTreeMap, BTreeSet};

/// Columns of a parameter card that hold data.
const WIDTH: usize = 64;

/// Most matrices in a chain, each placed by the next.
const MAX_CHAIN: usize = 32;

/// Parts of a composite meet when their gap is no wider than this, mm (or ten times the file's own resolution).
const GAP_MM: f64 = 0.01;

const COMPOSITE: u32 = 102;
const MATRIX: u32 = 124;
const PROPERTY: u32 = 406;
const NAME_FORM: i32 = 15;

/// Reads the curves of an IGES file of fixed format and lists everything else.
///
/// A broken entity is skipped with a warning; a broken file is refused.
///
/// # Errors
/// [`IgesError`] with the line and the reason.
pub fn read(bytes: &[u8]) -> Result<IgesFile, IgesError> {
    let sections = cards::sort(bytes)?;
    let mut warnings = Vec::new();
    let global = global::read(&sections.global, &mut warnings)?;
    let entries = directory::read(&sections.directory)?;
    check_announced(&sections, &mut warnings);
    let count = entries.len();
    let drawing = Drawing { global, entries, cards: &sections.parameters, warnings, read: vec![false; count] };
    Ok(drawing.into_file())
}

fn check_announced(sections: &cards::Cards, warnings: &mut Vec<String>) {
    for &(letter, announced) in &sections.announced {
        let found = match letter {
            'G' => sections.global.len(),
            'D' => sections.directory.len(),
            _ => sections.parameters.len(),
        };
        if found != announced {
            warnings.push(format!(
                "The last card announces {announced} {letter} cards, but there are {found}: cards were lost or \
                 added. Export the drawing again if a curve is missing."
            ));
        }
    }
}

struct Drawing<'a> {
    global: Global,
    entries: Vec<Entry>,
    /// Parameter cards.
    cards: &'a [Card<'a>],
    warnings: Vec<String>,
    /// For each entry, whether it was read.
    read: Vec<bool>,
}

/// A curve before it is added to the file: its parts in file units, and its name property.
type Placed = (Vec<Nurbs>, Option<String>);

impl Drawing<'_> {
    fn into_file(mut self) -> IgesFile {
        self.note_matrices();
        let mut placed: BTreeMap<usize, Placed> = BTreeMap::new();
        for i in 0..self.entries.len() {
            if entities::is_curve(self.entries[i].entity) {
                let curve = self.single(i);
                self.keep(i, curve, &mut placed);
            }
        }
        let mut parametric = self.parametric();
        for i in 0..self.entries.len() {
            if self.entries[i].entity == COMPOSITE {
                let curve = self.composite(i, &placed, &mut parametric);
                self.keep(i, curve, &mut placed);
            }
        }
        let curves = placed.into_iter().map(|(i, curve)| self.finish(i, curve, parametric.contains(&i))).collect();
        let entities = self.counts();
        self.warn_of_unread(&entities);
        let Global { unit_mm, system, .. } = self.global;
        IgesFile { curves, entities, warnings: self.warnings, unit_mm, system }
    }

    fn keep(&mut self, i: usize, curve: Result<Placed, String>, placed: &mut BTreeMap<usize, Placed>) {
        let is_finite = |curve: &Placed| curve.0.iter().flat_map(|c| c.control_points()).all(|p| p.is_finite());
        match curve {
            Ok(curve) if is_finite(&curve) => {
                self.read[i] = true;
                placed.insert(i, curve);
            }
            Ok(_) => self.warn(i, "its matrix moves it infinitely far away"),
            Err(reason) => self.warn(i, &reason),
        }
    }

    fn warn(&mut self, i: usize, reason: &str) {
        let reason = reason.trim_end_matches('.');
        let place = self.place(i);
        self.warnings.push(format!("The {place} was not read: {reason}. Export it again, or redraw it."));
    }

    /// Its location in words: `circular arc at directory entry D19`.
    fn place(&self, i: usize) -> String {
        format!("{} at directory entry D{}", names::name(self.entries[i].entity), self.entries[i].number)
    }

    /// Index of the entry that a pointer refers to.
    fn entry(&self, pointer: i64) -> Result<usize, String> {
        let index = usize::try_from(pointer.unsigned_abs()).unwrap_or(usize::MAX);
        match index % 2 == 1 && index / 2 < self.entries.len() {
            true => Ok(index / 2),
            false => Err(format!("it points to directory entry D{pointer}, which does not exist")),
        }
    }

    fn parameters(&self, i: usize) -> Result<Parameters, String> {
        let Entry { first_card, cards, entity, .. } = self.entries[i];
        let first = first_card.wrapping_sub(1);
        let own = first.checked_add(cards.max(1)).and_then(|end| self.cards.get(first..end)).ok_or_else(|| {
            format!("its {cards} P cards begin at P{first_card}, but the file has {}", self.cards.len())
        })?;
        let parameters = Text::new(own, WIDTH).split(0, self.global.delimiters)?;
        match parameters.integer(0) {
            Ok(found) if found == i64::from(entity) => Ok(parameters),
            _ => Err(format!(
                "its parameters on line {} begin with \"{}\", not {entity}",
                own[0].line,
                parameters.text(0)
            )),
        }
    }

    fn note_matrices(&mut self) {
        for i in 0..self.entries.len() {
            if self.entries[i].entity == MATRIX {
                match self.parameters(i).and_then(|p| entities::matrix(&p)) {
                    Ok(_) => self.read[i] = true,
                    Err(reason) => self.warn(i, &reason),
                }
            }
        }
    }

    /// The product of the matrices that place an entity; each one that follows in the chain is multiplied on the left.
    fn matrix(&self, mut pointer: i64) -> Result<DAffine3, String> {
        let mut place = DAffine3::IDENTITY;
        for _ in 0..MAX_CHAIN {
            if pointer == 0 {
                return Ok(place);
            }
            let i = self.entry(pointer)?;
            if self.entries[i].entity != MATRIX {
                return Err(format!("its matrix should be at D{pointer}, where there is a {}", self.place(i)));
            }
            let own = self.parameters(i).and_then(|p| entities::matrix(&p));
            place = own.map_err(|reason| format!("its matrix at D{pointer} is broken: {reason}"))? * place;
            pointer = self.entries[i].matrix;
        }
        Err("its matrices point to each other in a loop".to_owned())
    }

    /// A curve other than a composite, in place.
    fn single(&mut self, i: usize) -> Result<Placed, String> {
        let parameters = self.parameters(i)?;
        let (curve, last) = entities::curve(self.entries[i].entity, self.entries[i].form, &parameters)?;
        let curve = match self.entries[i].matrix {
            0 => curve,
            pointer => curve.transformed(&self.matrix(pointer)?),
        };
        Ok((vec![curve], self.name_property(&parameters, last)))
    }

    /// 102: pointers to the members, in order.
    fn composite(
        &mut self,
        i: usize,
        placed: &BTreeMap<usize, Placed>,
        parametric: &mut BTreeSet<usize>,
    ) -> Result<Placed, String> {
        let parameters = self.parameters(i)?;
        let count = parameters.count(1, 1)?;
        let place = self.matrix(self.entries[i].matrix)?;
        let (mut parts, mut members): (Vec<Nurbs>, BTreeSet<usize>) = (Vec::new(), BTreeSet::new());
        for k in 0..count {
            let member = self.entry(parameters.integer(2 + k)?)?;
            let found = placed.get(&member).filter(|_| self.entries[member].entity != COMPOSITE);
            let (curves, _) = found.ok_or_else(|| format!("its member, the {}, is not read", self.place(member)))?;
            if !members.insert(member) {
                return Err(format!("it holds the {} twice", self.place(member)));
            }
            parts.extend(
                curves.iter().map(|c| if place == DAffine3::IDENTITY { c.clone() } else { c.transformed(&place) }),
            );
        }
        if parts.is_empty() {
            return Err("it has no members".to_owned());
        }
        if parametric.contains(&i) {
            parametric.extend(members);
        } else {
            parts = self.joined(i, parts);
        }
        Ok((parts, self.name_property(&parameters, 1 + count)))
    }

    /// The parts in the order in which they meet; warns when they are listed in another order, or do not meet.
    fn joined(&mut self, i: usize, parts: Vec<Nurbs>) -> Vec<Nurbs> {
        let unit = self.global.unit_mm;
        let place = self.place(i);
        match chain::join(parts, GAP_MM.max(10.0 * self.global.resolution_mm) / unit) {
            Chain::InOrder(parts) => parts,
            Chain::Reordered(parts) => {
                let text = format!("The parts of the {place} are listed out of sequence; they were put in order.");
                self.warnings.push(text);
                parts
            }
            Chain::Gap(parts, widest) => {
                let widest = widest * unit;
                self.warnings.push(format!(
                    "The parts of the {place} do not meet: the widest gap is {widest:.3} mm. Close it in the drawing \
                     if it is to be one wall."
                ));
                parts
            }
        }
    }

    /// Entries of curves that lie in the parameter plane of a surface.
    fn parametric(&self) -> BTreeSet<usize> {
        let flagged = (0..self.entries.len()).filter(|&i| self.entries[i].usage == 5);
        // A curve on a surface (142) names its curve in the parameter plane third.
        let pointed = (0..self.entries.len()).filter(|&i| self.entries[i].entity == 142).filter_map(|i| {
            let pointer = self.parameters(i).and_then(|p| p.integer(3)).ok().filter(|&p| p != 0)?;
            self.entry(pointer).ok()
        });
        flagged.chain(pointed).collect()
    }

    /// The name given by a property. After an entity's own parameters come the number of associativities and pointers
    /// to them, then the same for properties.
    fn name_property(&mut self, parameters: &Parameters, last: usize) -> Option<String> {
        let associativities = parameters.count(last + 1, 1).ok()?;
        let at = last + 2 + associativities;
        let pointers = (0..parameters.count(at, 1).ok()?).filter_map(|k| parameters.integer(at + 1 + k).ok());
        let entries = pointers.filter_map(|pointer| self.entry(pointer).ok());
        let is_name = |i: &usize| self.entries[*i].entity == PROPERTY && self.entries[*i].form == NAME_FORM;
        let property = entries.into_iter().find(is_name)?;
        let name = self.parameters(property).ok()?.text(2).to_owned();
        self.read[property] = true;
        Some(name).filter(|name| !name.is_empty())
    }

    fn finish(&self, i: usize, (mut parts, name): Placed, is_parametric: bool) -> IgesCurve {
        let entry = &self.entries[i];
        let unit = self.global.unit_mm;
        if !is_parametric && unit != 1.0 {
            let scale = DAffine3::from_scale(DVec3::splat(unit));
            parts.iter_mut().for_each(|part| *part = part.transformed(&scale));
        }
        IgesCurve {
            entry: entry.number,
            entity: entry.entity,
            form: entry.form,
            name: name.unwrap_or_else(|| entry.label.clone()),
            level: entry.level,
            parts,
            dependence: entry.dependence,
            is_visible: entry.is_visible,
            is_parametric,
        }
    }

    fn counts(&self) -> Vec<EntityCount> {
        let mut counts: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
        for (entry, read) in self.entries.iter().zip(&self.read) {
            let count = counts.entry(entry.entity).or_default();
            if *read { count.0 += 1 } else { count.1 += 1 }
        }
        let counted = |(entity, (read, unread))| EntityCount { entity, name: names::name(entity), read, unread };
        counts.into_iter().map(counted).collect()
    }

    /// Warns of kinds that are not read at all; single failures have their own warnings.
    fn warn_of_unread(&mut self, counts: &[EntityCount]) {
        for EntityCount { entity, name, unread, .. } in counts {
            let is_read = entities::is_curve(*entity) || matches!(*entity, COMPOSITE | MATRIX);
            if *unread > 0 && !is_read {
                let what = if *unread == 1 { "entity" } else { "entities" };
                self.warnings.push(format!("{unread} {what} of type {entity} ({name}) not read: only curves are."));
            }
        }
    }
}
