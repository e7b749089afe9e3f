//! Programs for weld deposition: layers become neutral instructions, and these the languages of robots and machines. Programs are
//! read back to moves as well. Nothing here plans, and nothing knows of profiles.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`program`] | instructions: straight moves and arcs, arc on and off, layer by layer |
//! | [`dialect`] | one folder a language: KRL, RAPID, FANUC TP, INFORM, URScript, G-code |
//! | [`number`] | numbers written as controllers and tables take them |
//! | [`template`] | pages and texts with places for values |

pub mod dialect;
pub mod number;
pub mod program;
pub mod template;
