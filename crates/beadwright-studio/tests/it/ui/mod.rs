//! The window, headless, by the widgets a person uses.

mod background;
mod basic;
mod compare;
mod distortion;
mod edit;
mod export;
mod faults;
mod files;
mod flat;
mod found;
mod holding;
mod keyboard;
mod linked;
mod panels;
mod pictures;
mod place;
mod placement;
mod play;
mod preform;
mod program;
mod range;
mod scan;
mod space;
mod start;
mod trial;
mod words;
