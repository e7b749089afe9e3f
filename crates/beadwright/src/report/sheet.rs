//! A page of pictures and tables: `compare.html`, `simulate.html` and the pages of `reproduce`.

use super::bent::Bent;
use super::coloured::Coloured;
use super::{colours, encode, escape, words};
use crate::deposit::Picture;
use crate::palette::hex;
use crate::template;

/// A page that is put together piece by piece. All text is escaped.
#[derive(Debug, Clone)]
pub struct Sheet {
    title: String,
    lead: String,
    body: String,
}

/// Longer cells are sentences, not numbers or names.
const SENTENCE: usize = 40;

/// A row of a table: its cells, and whether each is to be marked as the best.
pub type Row = Vec<(String, bool)>;

impl Sheet {
    /// A page with a heading and a sentence.
    pub fn new(title: &str, lead: &str) -> Self {
        Self { title: title.to_owned(), lead: lead.to_owned(), body: String::new() }
    }

    /// A heading.
    pub fn heading(&mut self, text: &str) -> &mut Self {
        self.push(&format!("<h2>{}</h2>", escape(text)))
    }

    /// A paragraph.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.push(&format!("<p>{}</p>", escape(text)))
    }

    /// A table. Columns with sentences begin on the left, those with numbers end on the right.
    pub fn table(&mut self, head: &[&str], rows: &[Row]) -> &mut Self {
        let is_said = |k: usize| rows.iter().any(|row| row.get(k).is_some_and(|(text, _)| text.len() > SENTENCE));
        let said: Vec<usize> = (0..head.len()).filter(|k| is_said(*k)).collect();
        let class = |k: usize| if said.contains(&k) { " class=\"said\"" } else { "" };
        let cell = |(k, (text, best)): (usize, &(String, bool))| {
            format!("<td{}>{}</td>", if *best { " class=\"best\"" } else { class(k) }, escape(text))
        };
        let row = |row: &Row| format!("<tr>{}</tr>", row.iter().enumerate().map(cell).collect::<String>());
        let headed = |(k, text): (usize, &&str)| format!("<th scope=\"col\"{}>{}</th>", class(k), words::headed(text));
        let head: String = head.iter().enumerate().map(headed).collect();
        let rows: Vec<String> = rows.iter().map(row).collect();
        self.push(&format!("<div class=\"card wide\"><table><tr>{head}</tr>\n{}</table></div>", rows.join("\n")))
    }

    /// A finished SVG.
    pub fn svg(&mut self, svg: &str) -> &mut Self {
        self.push(&format!("<div class=\"card drawn\">{svg}</div>"))
    }

    /// Beads in 3-D, any two of the columns side by side under one slider and one camera; the layers are those of
    /// [`encode::shape`], and `labels` name the positions of the slider.
    pub fn beads(&mut self, labels: &[String], columns: &[(String, Vec<String>)]) -> &mut Self {
        let list = |texts: Vec<String>| texts.join(",\n");
        // Base64 needs no escaping.
        let layers = |layers: &[String]| list(layers.iter().map(|layer| format!("\"{layer}\"")).collect());
        let column = |(name, found): &(String, Vec<String>)| {
            format!("{{\"name\":{},\"layers\":[{}]}}", json(name), layers(found))
        };
        let labels = list(labels.iter().map(|label| json(label)).collect());
        let columns = list(columns.iter().map(column).collect());
        self.push(&format!(
            "<div class=\"card beads\"><script type=\"application/json\">{{\"labels\":[{labels}],\"columns\":[{columns}]}}</script></div>"
        ))
    }

    /// A body that bends, in 3-D, under a slider that exaggerates how far it moves.
    pub fn bent(&mut self, bent: &Bent) -> &mut Self {
        let names: Vec<String> = bent.shapes.iter().map(|(name, _)| json(name)).collect();
        self.push(&format!(
            "<div class=\"card bent\"><script type=\"application/json\">{{\"shapes\":[{}],\"body\":\"{}\"}}</script></div>",
            names.join(","),
            bent.encoded()
        ))
    }

    /// Surfaces in 3-D, each in a colour that the key below them names.
    pub fn coloured(&mut self, name: &str, surfaces: &Coloured) -> &mut Self {
        let key = surfaces.key.iter().map(|(name, colour)| format!("[{},\"{}\"]", json(name), hex(*colour)));
        self.push(&format!(
            "<div class=\"card coloured\"><script type=\"application/json\">{{\"name\":{},\"key\":[{}],\"surface\":\"{}\"}}</script></div>",
            json(name),
            key.collect::<Vec<_>>().join(","),
            surfaces.encoded()
        ))
    }

    /// Finished SVGs side by side, each with what it shows.
    pub fn svgs(&mut self, pictures: &[(String, String)]) -> &mut Self {
        let figure = |(caption, svg): &(String, String)| {
            format!("<figure>{svg}<figcaption>{}</figcaption></figure>", escape(caption))
        };
        self.push(&format!("<div class=\"card grid\">{}</div>", pictures.iter().map(figure).collect::<String>()))
    }

    /// Height fields side by side under a slider; `labels` name the positions of the slider.
    pub fn maps(&mut self, labels: &[String], columns: &[(String, Vec<Option<&Picture>>)]) -> &mut Self {
        self.fields("null", labels, columns)
    }

    /// Like [`Self::maps`], with heights other than those of beads: their scale ends `most` mm below and above 0.
    pub fn heights(&mut self, most: f64, labels: &[String], columns: &[(String, Vec<Option<&Picture>>)]) -> &mut Self {
        self.fields(&format!("[{},{most}]", -most), labels, columns)
    }

    fn fields(&mut self, span: &str, labels: &[String], columns: &[(String, Vec<Option<&Picture>>)]) -> &mut Self {
        let map = |picture: &Option<&Picture>| format!("\"{}\"", picture.map(encode::map).unwrap_or_default());
        let column = |(name, pictures): &(String, Vec<Option<&Picture>>)| {
            let maps: Vec<String> = pictures.iter().map(map).collect();
            format!("{{\"name\":{},\"maps\":[{}]}}", json(name), maps.join(",\n"))
        };
        let columns: Vec<String> = columns.iter().map(column).collect();
        let labels: Vec<String> = labels.iter().map(|label| json(label)).collect();
        self.push(&format!(
            "<div class=\"card maps\"><script type=\"application/json\">{{\"span\":{span},\"labels\":[{}],\"columns\":[{}]}}</script></div>",
            labels.join(","),
            columns.join(",\n")
        ))
    }

    /// The page.
    pub fn html(&self) -> String {
        let values = [
            ("title", escape(&self.title)),
            ("lead", escape(&self.lead)),
            ("css", colours::css() + include_str!("sheet.css")),
            ("body", self.body.clone()),
            ("js", colours::js() + &self.scripts()),
        ];
        template::expand(include_str!("sheet.html"), &values)
    }

    /// The scripts; those of the 3-D view only where there is one.
    fn scripts(&self) -> String {
        let flat = [include_str!("inflate.js"), include_str!("heat.js"), include_str!("sheet.js")];
        let deep = [
            include_str!("layers.js"),
            include_str!("lie.js"),
            include_str!("camera.js"),
            include_str!("steer.js"),
            include_str!("strands.js"),
            include_str!("shaders.js"),
            include_str!("scene.js"),
            include_str!("pace.js"),
        ];
        let (beads, bent, coloured) = (self.has("beads"), self.has("bent"), self.has("coloured"));
        let own = [
            (beads, include_str!("twins.js")),
            (bent || coloured, include_str!("mesh.js")),
            (bent, include_str!("ramp.js")),
            (bent, include_str!("bent.js")),
            (coloured, include_str!("coloured.js")),
        ];
        let deep = deep.iter().filter(|_| own.iter().any(|(is_there, _)| *is_there));
        let own = own.iter().filter(|(is_there, _)| *is_there).map(|(_, script)| script);
        flat.iter().chain(deep).chain(own).copied().collect()
    }

    /// Whether it has a card of this class.
    fn has(&self, class: &str) -> bool {
        self.body.contains(&format!("class=\"card {class}\""))
    }

    fn push(&mut self, html: &str) -> &mut Self {
        self.body.push_str(html);
        self.body.push('\n');
        self
    }
}

/// A string for JSON that is safe in a `script` element.
fn json(text: &str) -> String {
    serde_json::Value::from(text).to_string().replace('<', "\\u003c")
}
