//! Solids in 3MF, OBJ, PLY and AMF: the same part whatever the file, and a sentence for whatever is broken.

use crate::common;

use beadwright::example;
use beadwright::model::{self, Import, ImportError, Mesh, Placement, Solids, Units, import};
use beadwright::task::Task;
use common::models;
use glam::{DVec2, DVec3};
use std::fmt::Write as _;
use std::io::Write as _;
use zip::write::SimpleFileOptions;

fn read(bytes: &[u8]) -> Result<Import, ImportError> {
    import(bytes, &Task::new())
}

fn cross() -> Mesh {
    example::find("cross").unwrap().mesh()
}

fn near(import: &Import, mesh: &Mesh, factor: f64) {
    let (volume, expected) = (import.mesh.volume(), mesh.volume() * factor.powi(3));
    assert!((volume / expected - 1.0).abs() < 1e-5, "{} holds {volume} mm³ for {expected}", import.format);
    assert!(
        import.mesh.size().distance(mesh.size() * factor) < 1e-3 && import.repair.is_clean(),
        "{:?}",
        import.repair
    );
}

fn obj(mesh: &Mesh) -> String {
    let mut text = String::from("# made by a test\nmtllib none.mtl\no part\n");
    mesh.vertices.iter().for_each(|v| writeln!(text, "v {} {} {} 1.0", v.x, v.y, v.z).unwrap());
    text.push_str("vn 0 0 1\nvt 0 0\n");
    let count = mesh.vertices.len() as i64;
    for (k, [a, b, c]) in mesh.triangles.iter().map(|t| t.map(i64::from)).enumerate() {
        match k % 3 {
            0 => writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap(),
            1 => writeln!(text, "f {}/1/1 {}//1 {}/1", a + 1, b + 1, c + 1).unwrap(),
            _ => writeln!(text, "f {} {} {}", a - count, b - count, c - count).unwrap(),
        }
    }
    text
}

fn ply(mesh: &Mesh, format: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {format} 1.0\ncomment made by a test\nelement vertex {}\nproperty float x\nproperty float y\nproperty double z\n\
         property uchar red\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.vertices.len(),
        mesh.triangles.len()
    )
    .into_bytes();
    let little = format.contains("little");
    let four = |bytes: [u8; 4]| if little { bytes } else { [bytes[3], bytes[2], bytes[1], bytes[0]] };
    let eight = |mut bytes: [u8; 8]| {
        if !little {
            bytes.reverse();
        }
        bytes
    };
    for v in &mesh.vertices {
        if format == "ascii" {
            writeln!(bytes, "{} {} {} 200", v.x, v.y, v.z).unwrap();
        } else {
            bytes.extend([v.x, v.y].iter().flat_map(|c| four((*c as f32).to_le_bytes())));
            bytes.extend(eight(v.z.to_le_bytes()));
            bytes.push(200);
        }
    }
    for t in &mesh.triangles {
        if format == "ascii" {
            writeln!(bytes, "3 {} {} {}", t[0], t[1], t[2]).unwrap();
        } else {
            bytes.push(3);
            bytes.extend(t.iter().flat_map(|i| four((*i as i32).to_le_bytes())));
        }
    }
    bytes
}

fn mesh_xml(mesh: &Mesh) -> String {
    let mut text = String::from("<mesh><vertices>");
    mesh.vertices.iter().for_each(|v| write!(text, "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", v.x, v.y, v.z).unwrap());
    text.push_str("</vertices><triangles>");
    mesh.triangles
        .iter()
        .for_each(|t| write!(text, "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>", t[0], t[1], t[2]).unwrap());
    text + "</triangles></mesh>"
}

const MODEL: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
const RELATIONS: &str = "<Relationships><Relationship Target=\"/3D/part.model\" Id=\"r\" \
                         Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

fn archive(files: &[(&str, &str)]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, text) in files {
        zip.start_file(*name, SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn threemf(unit: &str, resources: &str, build: &str) -> Vec<u8> {
    let text = format!(
        "<?xml version=\"1.0\"?><model unit=\"{unit}\" xmlns=\"{MODEL}\"><resources>{resources}</resources><build>{build}</build></model>"
    );
    archive(&[("_rels/.rels", RELATIONS), ("3D/part.model", &text)])
}

fn object(id: u32, body: &str) -> String {
    format!("<object id=\"{id}\" name=\"part {id} &amp; more\" type=\"model\">{body}</object>")
}

fn amf(mesh: &Mesh, unit: &str) -> String {
    let mut text = format!("<?xml version=\"1.0\"?>\n<amf unit=\"{unit}\"><object id=\"7\"><mesh><vertices>");
    for v in &mesh.vertices {
        write!(text, "<vertex><coordinates><x>{}</x><y>{}</y><z>{}</z></coordinates></vertex>", v.x, v.y, v.z).unwrap();
    }
    text.push_str("</vertices><volume>");
    for t in &mesh.triangles {
        write!(text, "<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>", t[0], t[1], t[2]).unwrap();
    }
    text + "</volume></mesh></object></amf>"
}

/// Constellations turn about x, then y, then z, and place copies and each other; what they place is nowhere else.
#[test]
fn constellations_place_copies() {
    let mesh = cross();
    let whole = amf(&mesh, "inch");
    let object = whole.split_once("<object").unwrap().1.strip_suffix("</amf>").unwrap();
    let file = |rest: &str| format!("<amf unit=\"inch\"><object{object}{rest}</amf>");
    let placed = file(
        "<constellation id=\"2\"><instance objectid=\"7\"><deltax>1</deltax><rx>90</rx><rz>90</rz></instance>\
         <instance objectid=\"7\"><deltay>-3000</deltay></instance></constellation>\
         <constellation id=\"3\"><instance objectid=\"2\"><deltaz>500</deltaz></instance></constellation>",
    );
    let import = read(placed.as_bytes()).unwrap();
    let single = read(file("").as_bytes()).unwrap().mesh;
    assert!((import.mesh.volume() / single.volume() - 2.0).abs() < 1e-4);
    assert_eq!(import.objects.iter().map(|o| o.name.as_str()).collect::<Vec<_>>(), ["constellation 3"]);
    // (x, y, z) turned about x by 90° is (x, −z, y), that about z by 90° (z, x, y); then moved, in inches.
    let at = |v: DVec3| DVec3::new(v.z + 25.4, v.x, v.y + 500.0 * 25.4);
    let turned: Vec<DVec3> = single.vertices.iter().map(|v| at(*v)).collect();
    let (low, high) = import.mesh.bounds();
    let highest = |axis: fn(&DVec3) -> f64| turned.iter().map(axis).fold(f64::MIN, f64::max);
    let tops = [highest(|v| v.x), highest(|v| v.y), highest(|v| v.z)];
    let own = single.bounds();
    assert!((high.x - tops[0].max(own.1.x)).abs() < 0.01, "{high}");
    assert!((high.z - tops[2].max(own.1.z + 12_700.0)).abs() < 0.01 && (high.y - tops[1]).abs() < 0.01, "{high}");
    assert!((low.y - (own.0.y - 3000.0 * 25.4)).abs() < 0.1, "{low}");
    let refused = |text: String, why: &str| {
        let error = read(text.as_bytes()).unwrap_err().to_string();
        assert!(error.contains(why), "{error}");
    };
    refused(file("<constellation id=\"2\"><instance objectid=\"9\"></instance></constellation>"), "object 9");
    let own = "<constellation id=\"2\"><instance objectid=\"7\"></instance><instance objectid=\"3\"></instance></constellation>\
               <constellation id=\"3\"><instance objectid=\"2\"></instance></constellation>\
               <constellation id=\"4\"><instance objectid=\"3\"></instance></constellation>";
    refused(file(own), "in themselves");
}

#[test]
fn a_part_is_the_same_in_every_format() {
    let mesh = cross();
    let obj = read(obj(&mesh).as_bytes()).unwrap();
    near(&obj, &mesh, 1.0);
    assert_eq!((obj.format, obj.units), ("OBJ", None));
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        near(&read(&ply(&mesh, format)).unwrap(), &mesh, 1.0);
    }
    for (unit, factor) in [("millimeter", 1.0), ("inch", 25.4), ("meter", 1000.0)] {
        let read_amf = read(amf(&mesh, unit).as_bytes()).unwrap();
        near(&read_amf, &mesh, factor);
        assert_eq!((read_amf.units, read_amf.objects[0].name.as_str()), (Some(Units::Millimetre), "object 7"));
    }
    for (unit, factor) in
        [("micron", 1e-3), ("millimeter", 1.0), ("centimeter", 10.0), ("inch", 25.4), ("foot", 304.8), ("meter", 1e3)]
    {
        let bytes = threemf(unit, &object(1, &mesh_xml(&mesh)), "<item objectid=\"1\"/>");
        let read = read(&bytes).unwrap();
        near(&read, &mesh, factor);
        assert_eq!((read.units, read.objects[0].name.as_str()), (Some(Units::Millimetre), "part 1 & more"));
    }
}

/// A block, a post that stands on it with a face in common, and one that reaches into it, turned and moved when they are placed.
#[test]
fn objects_of_a_file_name_their_solids_even_where_these_touch() {
    let block = |low: [f64; 3], high: [f64; 3]| {
        let corner =
            |k: usize| DVec3::from_array([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] }));
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        Mesh::from_triangles((0..8).map(corner).collect(), triangles).0
    };
    let blocks = [
        block([0.0, 0.0, 0.0], [60.0, 40.0, 20.0]),
        block([0.0, 0.0, 20.0], [60.0, 40.0, 50.0]),
        block([50.0, 10.0, 5.0], [90.0, 30.0, 15.0]),
    ];
    let objects: String = blocks.iter().zip(1..).map(|(mesh, id)| object(id, &mesh_xml(mesh))).collect();
    let items: String = (1..=3).map(|id| format!("<item objectid=\"{id}\"/>")).collect();
    let read = read(&threemf("millimeter", &objects, &items)).unwrap();
    assert_eq!(read.objects.iter().map(|object| object.at.len()).collect::<Vec<_>>(), [1, 1, 1]);
    for turn in [DVec3::ZERO, DVec3::new(0.0, 0.0, 37.0), DVec3::new(90.0, 17.0, 200.0)] {
        let placement = Placement { turn, scale: 2.0, shift: DVec2::new(-80.0, 12.5), ..Placement::default() };
        let placed = placement.solid(read.clone(), 5.0).unwrap();
        let solids = Solids::of(&placed.mesh);
        assert_eq!(solids.count(), 3);
        for (object, own) in placed.objects.iter().zip(&blocks) {
            let found = solids.mesh(&[solids.nearest(object.at[0]).unwrap()]);
            assert!((found.volume() - 8.0 * own.volume()).abs() < 1e-3, "{}, {turn}", object.name);
        }
    }
}

/// Copies by components and items, turned, mirrored and moved, some of them in another file of the archive.
#[test]
fn components_and_transforms_place_copies() {
    let mesh = cross();
    let parts = object(1, &mesh_xml(&mesh))
        + &object(
            2,
            "<components><component objectid=\"1\"/><component objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 200 0 0\"/></components>",
        );
    let build = "<item objectid=\"2\"/><item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 -300 0 0\"/>";
    let three = read(&threemf("millimeter", &parts, build)).unwrap();
    assert!((three.mesh.volume() / mesh.volume() - 3.0).abs() < 1e-5 && three.repair.shells == 3);
    let size = mesh.size();
    assert!(
        (three.mesh.size().x
            - (500.0 + (size.x + size.y) / 2.0 + mesh.bounds().1.x
                - (mesh.bounds().0.x + mesh.bounds().1.x) / 2.0
                - size.x / 2.0))
            .abs()
            < size.max_element()
    );
    assert_eq!(three.objects.iter().map(|o| o.triangles / mesh.triangles.len()).collect::<Vec<_>>(), [2, 1]);
    let other = format!(
        "<model unit=\"millimeter\" xmlns=\"{MODEL}\"><resources>{}</resources></model>",
        object(9, &mesh_xml(&mesh))
    );
    let main = format!(
        "<model xmlns=\"{MODEL}\" xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" requiredextensions=\"p\"><resources>{}\
         </resources><build><item objectid=\"3\"/></build></model>",
        object(3, "<components><component objectid=\"9\" p:path=\"/3D/other.model\"/></components>")
    );
    let bytes = archive(&[("_rels/.rels", RELATIONS), ("3D/part.model", &main), ("3D/other.model", &other)]);
    near(&read(&bytes).unwrap(), &mesh, 1.0);
}

/// Whatever is cut off, changed or hostile ends with a sentence, in bounded memory.
#[test]
fn broken_archives_are_refused() {
    let mesh = cross();
    let good = threemf("millimeter", &object(1, &mesh_xml(&mesh)), "<item objectid=\"1\"/>");
    for k in 1..16 {
        let cut = good.len() * k / 16;
        assert!(read(&good[..cut]).is_err(), "cut at {cut} of {}", good.len());
    }
    let refused = |bytes: Vec<u8>, part: &str| {
        let error = read(&bytes).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    };
    let item = "<item objectid=\"1\"/>";
    let itself = object(1, "<components><component objectid=\"1\"/></components>");
    refused(threemf("millimeter", &itself, item), "in themselves");
    refused(threemf("millimeter", "", item), "is missing");
    refused(threemf("millimeter", &object(1, &mesh_xml(&mesh)), ""), "no object");
    refused(threemf("furlong", &object(1, &mesh_xml(&mesh)), item), "furlong");
    refused(
        threemf("millimeter", &object(1, "<mesh><vertices><vertex x=\"a\" y=\"0\" z=\"0\"/></vertices></mesh>"), item),
        "not a number",
    );
    refused(
        threemf(
            "millimeter",
            &object(
                1,
                "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>",
            ),
            item,
        ),
        "refers to a missing vertex",
    );
    refused(
        threemf("millimeter", &object(1, &mesh_xml(&mesh)), "<item objectid=\"1\" transform=\"1 0 0\"/>"),
        "twelve numbers",
    );
    refused(
        threemf(
            "millimeter",
            &object(1, &mesh_xml(&mesh)),
            "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 0 0 0 0\"/>",
        ),
        "flat",
    );
    refused(archive(&[("readme.txt", "no model")]), "no model");
    let escape = RELATIONS.replace("/3D/part.model", "/../../etc/passwd");
    refused(archive(&[("_rels/.rels", &escape), ("3D/part.model", "")]), "not in it");
    // Doubled thirty times: a thousand million copies of one mesh.
    let mut bomb = object(1, &mesh_xml(&mesh));
    for k in 2..32 {
        let twice = format!("<component objectid=\"{}\"/>", k - 1).repeat(2);
        bomb += &object(k, &format!("<components>{twice}</components>"));
    }
    refused(threemf("millimeter", &bomb, "<item objectid=\"31\"/>"), "triangles");
    // 100 MB of one vertex, packed into a thousandth of that.
    let vertices = "<vertex x=\"0\" y=\"0\" z=\"0\"/>".repeat(3_500_000);
    let packed = threemf("millimeter", &object(1, &format!("<mesh><vertices>{vertices}")), item);
    assert!(packed.len() < 1_000_000, "{}", packed.len());
    refused(packed, "unpacks to more than 64 MB");
    // Five thousand million spaces, packed small, would take minutes: elements nested without end stand for it.
    refused(archive(&[("3D/3dmodel.model", &"<a>".repeat(300))]), "deep");
    let lattice = format!(
        "<model xmlns=\"{MODEL}\" xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\" requiredextensions=\"b\"/>"
    );
    refused(archive(&[("3D/3dmodel.model", &lattice)]), "beamlattice");
}

#[test]
fn broken_texts_name_their_line() {
    let refused = |bytes: &[u8], part: &str| {
        let error = read(bytes).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    };
    refused(b"v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n", "line 3");
    refused(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4");
    refused(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "no triangle with an area");
    refused(b"v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n", "not a finite number");
    let mesh = cross();
    let text = ply(&mesh, "ascii");
    refused(&text[..text.len() / 2], "PLY");
    let binary = ply(&mesh, "binary_little_endian");
    refused(&binary[..binary.len() - 5], "PLY");
    let many = String::from_utf8(text).unwrap().replacen("element face ", "element face 9999999", 1);
    refused(many.as_bytes(), "announces");
    let points = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n";
    refused(points, "point cloud");
    refused(amf(&mesh, "cubit").as_bytes(), "cubit");
    assert!(!model::is_solid(b"G21\nG90\nG1 X1\n") && model::is_solid(b"v 0 0 0\n"));
}

/// Files of others: the same part as STL and as 3MF, and parts with many objects.
#[test]
#[cfg_attr(no_models, ignore = "the shared models are not here")]
fn files_of_others() {
    let of = |name: &str| read(&std::fs::read(models().join(name)).unwrap()).unwrap();
    let (stl, threemf) = (of("featuretype.stl"), of("featuretype.3mf"));
    let scale = threemf.mesh.size() / stl.mesh.size();
    assert!(scale.distance(DVec3::splat(scale.x)) < 1e-3 * scale.x, "{scale}");
    let ratio = threemf.mesh.volume() / (stl.mesh.volume() * scale.x.powi(3));
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    let gears = of("cube_gears.3mf");
    assert!(
        gears.objects.len() >= 17 && gears.mesh.size().distance(DVec3::new(168.0, 125.1, 33.6)) < 0.2,
        "{}",
        gears.mesh.size()
    );
    assert!(of("3dbenchy.3mf").mesh.size().distance(DVec3::new(60.0, 31.0, 48.0)) < 0.1);
    let (obj, stl) = (of("bladex_propeller_zup_fixed.obj"), of("bladex_propeller_zup.stl"));
    assert!(obj.mesh.size().distance(stl.mesh.size()) < 1.0, "{} {}", obj.mesh.size(), stl.mesh.size());
    assert!(obj.repair.open_edges < stl.repair.open_edges, "{:?}", obj.repair);
    assert_eq!(of("self_intersect.obj").repair.triangles_read, 17_160);
}

#[test]
fn faces_of_an_obj_that_refer_nowhere_are_skipped_on_request() {
    let text = obj(&cross()) + "f 1 2 999999\nf 3 -999999 4\n";
    let Err(ImportError::Damaged { reason }) = read(text.as_bytes()) else { panic!("the file is taken") };
    assert!(reason.starts_with("2 faces refer to vertices") && reason.contains("line "), "{reason}");
    let taken = model::import_damaged(text.as_bytes(), &Task::new()).unwrap();
    assert_eq!(taken.repair.damage, Some(reason));
    assert!((taken.mesh.volume() / cross().volume() - 1.0).abs() < 1e-5);
}
