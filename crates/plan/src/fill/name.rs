//! The built-in strategies by the names that people type.

use super::Strategy;
use bead_part::text::toml::nearest;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Declares [`StrategyName`], one line a strategy. The words are the names of the variants in kebab-case, and
/// [`Strategy::name`] gives the same.
macro_rules! strategies {
    ($($(#[$about:meta])* $name:ident: $strategy:expr,)*) => {
        /// The name of a built-in strategy.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[non_exhaustive]
        pub enum StrategyName {
            $($(#[$about])* $name,)*
        }

        impl StrategyName {
            /// All of them, in the order in which they are listed to people.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// The strategy itself.
            ///
            /// ```
            /// use bead_plan::fill::StrategyName;
            ///
            /// let name: StrategyName = "zigzag".parse()?;
            /// assert_eq!((name, name.to_string().as_str()), (StrategyName::Zigzag, "zigzag"));
            /// // A wrong name gets the nearest one, and all of them.
            /// let refused = "zigzg".parse::<StrategyName>().map_err(|error| error.to_string());
            /// assert!(refused.is_err_and(|said| said.contains("Did you mean \"zigzag\"? The strategies are loop, raster, ")));
            /// # Ok::<(), bead_plan::fill::UnknownStrategy>(())
            /// ```
            pub fn strategy(self) -> &'static dyn Strategy {
                match self {
                    $(Self::$name => &$strategy,)*
                }
            }
        }
    };
}

strategies! {
    /// Rings that fill an island evenly, joined into one path.
    Loop: super::one_loop::OneLoop,
    /// Parallel scan lines, all in one direction.
    Raster: super::raster::Raster,
    /// Scan lines joined along the boundary.
    Zigzag: super::zigzag::Zigzag,
    /// Rings parallel to the boundary, until nothing is left.
    Contour: super::contour::Contour,
    /// Zigzag inside, then perimeters (Liu et al. 2022).
    Compound: super::compound::Compound,
    /// Contours, and their pockets filled along their medial axis (Zhao et al. 2023).
    Hybrid: super::hybrid::Hybrid,
    /// Contours connected into one path (Park et al. 2003).
    Spiral: super::spiral::Spiral,
    /// Connected Fermat spirals (Zhao et al. 2016).
    Fermat: super::fermat::Fermat,
    /// A Hilbert curve.
    Hilbert: super::hilbert::Hilbert,
    /// Zigzags in nearly convex cells (Ding et al. 2014).
    Partition: super::partition::Partition,
    /// Rings from the medial axis outwards (Ding et al. 2016).
    Mat: super::mat::Mat,
    /// Thin walls along their middle, in the fewest paths that do not cross (Li et al.).
    Wall: super::wall::Wall,
}

impl StrategyName {
    /// The word that people type.
    pub fn name(self) -> &'static str {
        self.strategy().name()
    }

    /// All names with commas between them, for messages and help.
    pub fn list() -> String {
        Self::ALL.iter().map(|name| name.name()).collect::<Vec<_>>().join(", ")
    }
}

impl fmt::Display for StrategyName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for StrategyName {
    type Err = UnknownStrategy;

    fn from_str(name: &str) -> Result<Self, UnknownStrategy> {
        let found = Self::ALL.iter().find(|known| known.name() == name);
        found.copied().ok_or_else(|| UnknownStrategy(name.to_owned()))
    }
}

/// No built-in strategy has this name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no strategy \"{0}\". {hint}The strategies are {known}.", hint = hint(.0), known = StrategyName::list())]
pub struct UnknownStrategy(
    /// The name that was given.
    pub String,
);

fn hint(name: &str) -> String {
    let near = nearest(name, StrategyName::ALL.iter().map(|known| known.name()));
    near.map(|near| format!("Did you mean \"{near}\"? ")).unwrap_or_default()
}
