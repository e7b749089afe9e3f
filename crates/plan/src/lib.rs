//! What is welded and what results: beads, passes and layers, fills and their order, the metal they lay and how hot it
//! gets. Nothing here knows about profiles, robots or their languages; the settings of every stage are in millimetres
//! and seconds.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`bead`] | width, height and stepover of beads, mass balance, measured beads |
//! | [`process`] | wire, arc, speeds, gas, starts and stops |
//! | [`motion`] | how long a path takes, with acceleration |
//! | [`pass`], [`layer`] | a path in space with width and pace along it; a layer's slice and passes |
//! | [`wedge`] | layers of varying thickness |
//! | [`fill`] | an island becomes paths: one file per strategy |
//! | [`order`] | the paths of a layer in sequence, with their start points |
//! | [`deposit`] | layers become a height field, with its voids and humps |
//! | [`weld`] | passes with start and stop, and the moves between them |
//! | [`heat`] | temperatures before and along passes, and waits within a limit |
//! | [`limit`] | the allowed range of every number in a profile, with its reason |
//! | [`preform`] | a part plus the stock that is milled off afterwards, and the orientation in which that costs least |
//! | [`random`] | seeded random numbers |
//! | [`trial`] | trial beads on plates: designs of experiments, numbers in weld metal, the sheet to fill in |

pub mod bead;
pub mod deposit;
pub mod fill;
pub mod heat;
pub mod layer;
pub mod limit;
pub mod motion;
pub mod order;
pub mod pass;
pub mod preform;
pub mod process;
pub mod random;
pub mod trial;
pub mod wedge;
pub mod weld;
