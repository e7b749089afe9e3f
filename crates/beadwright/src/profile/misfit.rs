//! Where a robot cell and a profile do not fit each other.

use super::Profile;
use crate::dialect;
use crate::robot::Cell;

/// Something in which a cell and a profile contradict each other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Misfit {
    /// The robot's controller does not read what is written.
    Dialect {
        /// What it reads.
        reads: String,
        /// What the profile writes, separated by commas.
        written: String,
    },
    /// The profile turns the part on a positioner, and the cell has none.
    NoPositioner,
    /// The part lies on a positioner in the cell, and the profile does not turn it.
    IdlePositioner,
    /// The profile turns a table, and the cell has none.
    NoTable,
    /// The profile moves the robot on a linear axis, and the cell has none.
    NoLinearAxis,
}

impl Misfit {
    /// What does not fit, and what to do, as a sentence.
    pub fn sentence(&self) -> String {
        match self {
            Self::Dialect { reads, written } => format!(
                "The profile writes {written}, but the robot of this cell reads {reads}: take a cell or a profile (posts) of the \
                 same robot."
            ),
            Self::NoPositioner => {
                "The profile turns the part on a positioner (program.positioner), but in this cell the part lies on none: write \
                 positioner = true into a cell of your own, and its [part] with all axes at 0."
            }
            .to_owned(),
            Self::IdlePositioner => {
                "In this cell the part lies on a positioner, but the profile has none: set program.positioner.".to_owned()
            }
            Self::NoTable => "The profile turns a table (program.table_angle, table_side), but this cell has no [table].".to_owned(),
            Self::NoLinearAxis => {
                "The profile moves the robot on a linear axis (program.linear_axis), but this cell has no [linear_axis].".to_owned()
            }
        }
    }
}

impl Profile {
    /// In what a cell does not fit the profile.
    ///
    /// ```
    /// use beadwright::Profile;
    /// use beadwright::robot::Cell;
    ///
    /// let (profile, cell) = (Profile::built_in("cmt-steel-abb")?, Cell::built_in("kuka-kr20-r1810")?);
    /// let sentence = profile.misfits(&cell).first().map(|misfit| misfit.sentence());
    /// assert!(sentence.is_some_and(|sentence| sentence.starts_with("The profile writes rapid")));
    /// assert_eq!(profile.misfits(&Cell::built_in("abb-irb1410")?), []);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn misfits(&self, cell: &Cell) -> Vec<Misfit> {
        let mut misfits = Vec::new();
        // What a dialect of one's own is for is not known.
        let all_known = self.posts.iter().all(|post| dialect::find(post).is_some());
        let is_known = |reads: &&String| all_known && dialect::find(reads).is_some();
        if let Some(reads) = cell.dialect.as_ref().filter(is_known).filter(|_| !self.posts.is_empty())
            && !self.posts.contains(reads)
        {
            misfits.push(Misfit::Dialect { reads: reads.clone(), written: self.posts.join(", ") });
        }
        let program = &self.program;
        let turns_table = program.table_angle.is_some() || program.table_side.is_some();
        let found = [
            (program.positioner.is_some() && !cell.positioner, Misfit::NoPositioner),
            (program.positioner.is_none() && cell.positioner, Misfit::IdlePositioner),
            (turns_table && cell.table.is_none(), Misfit::NoTable),
            (program.linear_axis.is_some() && cell.linear_axis.is_none(), Misfit::NoLinearAxis),
        ];
        misfits.extend(found.into_iter().filter(|(is, _)| *is).map(|(_, misfit)| misfit));
        misfits
    }
}
