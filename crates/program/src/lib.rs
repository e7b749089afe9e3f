//! Programs for weld deposition: layers become neutral instructions, and these become the languages of robots and machines.
//! Programs are also read back as moves. Nothing here plans, and nothing knows about profiles.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`program`] | instructions: straight moves and arcs, arc on and off, layer by layer |
//! | [`dialect`] | one folder per language: KRL, RAPID, FANUC TP, INFORM, URScript, G-code |
//! | [`number`] | numbers written as controllers and tables accept them |
//! | [`template`] | pages and texts with placeholders |

pub mod dialect;
pub mod number;
pub mod program;
pub mod template;
