//! IGES files written by hand: any entities, any directory fields.
#![allow(dead_code, unreachable_pub)]

use beadwright::model::iges::{IgesFile, read};

/// A file of entities (type, form, parameters); entry k stands at D(2k + 1). Fields of the directory may be changed.
pub struct Draft {
    pub global: String,
    entities: Vec<(u32, i32, String)>,
    matrix: Vec<u32>,
    status: Vec<&'static str>,
}

impl Draft {
    pub fn new(entities: &[(u32, i32, &str)]) -> Self {
        let global = "1H,,1H;,4Hpart,8Hpart.igs,4Htest,3H1.0,32,38,6,308,15,4Hpart,1.0,2,2HMM,1,0.1,15H20260101.000000,\
                      1.0D-6,100.0,,,11,0,15H20260101.000000;";
        Self {
            global: global.to_owned(),
            entities: entities.iter().map(|(a, b, c)| (*a, *b, (*c).to_owned())).collect(),
            matrix: vec![0; entities.len()],
            status: vec!["00000000"; entities.len()],
        }
    }

    pub fn global(mut self, from: &str, to: &str) -> Self {
        assert!(self.global.contains(from));
        self.global = self.global.replace(from, to);
        self
    }

    pub fn matrix(mut self, entity: usize, pointer: u32) -> Self {
        self.matrix[entity] = pointer;
        self
    }

    pub fn status(mut self, entity: usize, status: &'static str) -> Self {
        self.status[entity] = status;
        self
    }

    /// The cards; text is cut wherever the columns end, as the standard allows for strings and most readers for all.
    pub fn cards(&self) -> Vec<String> {
        let card = |text: &str, letter: char, n: usize| format!("{text:<72}{letter}{n:>7}");
        let mut cards = vec![card("a test", 'S', 1)];
        let columns = |text: &str, width: usize| -> Vec<String> {
            text.as_bytes().chunks(width).map(|c| String::from_utf8(c.to_vec()).unwrap()).collect()
        };
        let global = columns(&self.global, 72);
        cards.extend(global.iter().enumerate().map(|(i, text)| card(text, 'G', i + 1)));
        let (mut directory, mut parameters) = (Vec::new(), Vec::new());
        for (k, (entity, form, text)) in self.entities.iter().enumerate() {
            let lines = columns(text, 64);
            let (first, matrix, status) = (parameters.len() + 1, self.matrix[k], self.status[k]);
            let text = format!("{entity:>8}{first:>8}{:>8}{:>8}{k:>8}{:>8}{matrix:>8}{:>8}{status:>8}", 0, 1, 0, 0);
            directory.push(card(&text, 'D', 2 * k + 1));
            let text = format!(
                "{entity:>8}{:>8}{:>8}{:>8}{form:>8}{:>16}{:>8}{:>8}",
                0,
                0,
                lines.len(),
                "",
                format!("E{k}"),
                0
            );
            directory.push(card(&text, 'D', 2 * k + 2));
            for line in lines {
                parameters.push(card(&format!("{line:<64} {:>7}", 2 * k + 1), 'P', parameters.len() + 1));
            }
        }
        let end = format!("S{:>7}G{:>7}D{:>7}P{:>7}", 1, global.len(), directory.len(), parameters.len());
        cards.into_iter().chain(directory).chain(parameters).chain([card(&end, 'T', 1)]).collect()
    }

    pub fn text(&self) -> String {
        self.cards().join("\n") + "\n"
    }

    pub fn read(&self) -> IgesFile {
        read(self.text().as_bytes()).unwrap()
    }
}
