//! STL files, good and bad: what is read, and what the message says when it is not.

use crate::solids;

use beadwright::model::import;
use beadwright::slice::{SliceOptions, Slicer};
use beadwright::task::Task;
use proptest::prelude::*;
use solids::{Facet, ascii, binary, cube, cuboid, flipped, runner};

/// `format, triangles, volume` of a file, or the message.
fn outcome(bytes: &[u8]) -> String {
    match import(bytes, &Task::new()) {
        Ok(i) => format!("{}, {} triangles, {:.3} mm³", i.format, i.mesh.triangles.len(), i.mesh.volume()),
        Err(error) => error.to_string(),
    }
}

/// The outcome contains all those words.
fn check(bytes: impl AsRef<[u8]>, expect: &[&str]) {
    let found = outcome(bytes.as_ref());
    assert!(expect.iter().all(|words| found.contains(words)), "{found:?} lacks one of {expect:?}");
}

const CUBE_BINARY: &[&str] = &["binary STL, 12 triangles, 1000.000 mm³"];
const CUBE_ASCII: &[&str] = &["ASCII STL, 12 triangles, 1000.000 mm³"];

#[test]
fn binary_files_are_read_whatever_their_header_says() {
    let headers: [&[u8]; 6] =
        [b"", b"solid cube", b"  SOLID\nfacet normal 0 0 1", b"COLOR=\xff\x80\x00\xff", b"\x00\x01\x02", &[0xff; 80]];
    for header in headers {
        check(binary(header, &cube()), CUBE_BINARY);
    }
}

#[test]
fn headers_that_look_like_other_formats_do_not_hide_a_binary_file() {
    // The size is 84 + 50 · n: this is STL beyond doubt.
    for header in [&b"written by cad\nv 1.2"[..], b"v 8.1 export", b"ply\n", b"PK\x03\x04", b"\x1f\x8b"] {
        check(binary(header, &cube()), CUBE_BINARY);
    }
}

#[test]
fn attribute_bytes_and_appended_data_are_passed_over() {
    let mut bytes = binary(b"colours", &cube());
    bytes[84..].chunks_mut(50).for_each(|record| record[48..].fill(0xab));
    check(&bytes, CUBE_BINARY);
    bytes.extend(b"appended by some program");
    check(&bytes, CUBE_BINARY);
}

#[test]
fn ascii_is_read_in_any_case_and_spacing() {
    let text = ascii("Cube", &cube());
    let mixed = text.replace("facet", "Facet").replace("vertex", "VerTex").replace("solid", "Solid");
    for text in [
        text.clone(),
        text.to_uppercase(),
        mixed,
        text.replace('\n', "\r\n"),
        text.replace("    ", "\t").replace("  ", " \t "),
        format!("\n  {text}\n\n"),
        text.trim_end().to_owned(),
        text.replace("solid Cube", "solid"),
    ] {
        check(text, CUBE_ASCII);
    }
}

#[test]
fn names_of_solids_may_be_any_bytes() {
    for name in ["月亮 facet", "Würfel vertex 1 2 3", "solid", "a b c"] {
        check(ascii(name, &cube()), CUBE_ASCII);
    }
    let latin1 = [&b"solid W\xfcrfel\n"[..], ascii("", &cube()).split_once('\n').unwrap().1.as_bytes()].concat();
    check(latin1, CUBE_ASCII);
}

#[test]
fn several_solids_in_one_file_are_one_part() {
    let second = cuboid([20.0, 0.0, 0.0], [25.0, 10.0, 10.0]);
    let text = ascii("one", &cube()) + &ascii("TWO", &second).to_uppercase();
    check(&text, &["ASCII STL, 24 triangles, 1500.000 mm³"]);
    assert_eq!(import(text.as_bytes(), &Task::new()).unwrap().repair.shells, 2);
}

#[test]
fn numbers_are_read_in_every_spelling() {
    let text = ascii("cube", &cube());
    for (plain, other) in [(" 10.0000", " +1.0E+01"), (" 10.0000", " 1000e-2"), (" 0.0000", " -0"), (" 0.0000", " .0")]
    {
        assert!(text.contains(plain));
        check(text.replace(plain, other), CUBE_ASCII);
    }
}

#[test]
fn a_normal_that_cannot_be_read_is_no_reason_to_refuse() {
    let text = ascii("cube", &cube());
    check(text.replace("normal 0 0 1", "normal nan nan nan").replace("normal 1 0 0", ""), CUBE_ASCII);
}

#[test]
fn normals_against_the_winding_are_counted() {
    let mut bytes = binary(b"", &cube());
    for record in bytes[84..].chunks_mut(50).take(3) {
        record[..12].as_chunks_mut::<4>().0.iter_mut().for_each(|b| *b = (-f32::from_le_bytes(*b)).to_le_bytes());
    }
    let import = import(&bytes, &Task::new()).unwrap();
    assert_eq!(import.repair.normals_against_winding, 3);
    assert_eq!(import.mesh.volume(), 1000.0);
}

#[test]
fn an_empty_file_is_refused() {
    check(b"", &["the file is empty (0 bytes)"]);
}

#[test]
fn a_truncated_binary_file_is_refused_with_byte_and_triangle() {
    let bytes = binary(b"cube", &cube());
    check(&bytes[..300], &["cut short", "announces 12 triangles", "684 bytes", "ends at byte 300", "in triangle 5"]);
    check(&bytes[..683], &["cut short", "ends at byte 683", "in triangle 12"]);
    let solid = binary(b"solid cube", &cube());
    check(&solid[..400], &["cut short", "ends at byte 400", "in triangle 7"]);
    check(&bytes[..50], &["not an STL file", "50 bytes", "at least 84"]);
}

#[test]
fn an_ascii_file_with_a_bad_number_is_refused_with_its_line() {
    let text = ascii("cube", &cube());
    let mut lines: Vec<&str> = text.lines().collect();
    // The fourth facet is on lines 23 to 29. Replaced line, by what, reported line, reported reason.
    for (line, bad, reported, expect) in [
        (25, "vertex 1.0 2,5 3.0", 25, "\"2,5\" is not a number"),
        (26, "vertex 1.0 2.5", 26, "three numbers are expected and one is missing"),
        (27, "vertex 1.0 2.5 \u{b5}", 27, "\"\u{b5}\" is not a number"),
        (27, "", 29, "the facet that ends here has 2 vertices, not 3"),
        (26, "vertex 1 1 1\nvertex 1 1 1", 30, "the facet that ends here has 4 vertices, not 3"),
        (29, "", 30, "a facet begins before the last one has ended"),
        (23, "", 25, "a vertex outside a facet"),
        (28, "endfacet", 29, "endfacet without a facet"),
    ] {
        let good = std::mem::replace(&mut lines[line - 1], bad);
        check(lines.join("\n"), &[&format!("line {reported} of the ASCII STL"), expect]);
        lines[line - 1] = good;
    }
}

#[test]
fn an_ascii_file_cut_in_a_facet_is_refused() {
    let text = ascii("cube", &cube());
    let cut = |lines: usize| text.lines().take(lines).collect::<Vec<_>>().join("\n");
    check(cut(32), &["cut short", "ends at line 32", "in triangle 5"]);
    check(cut(30), &["cut short", "ends at line 30", "in triangle 5"]);
    // Cut in the middle of a line.
    check(cut(32).trim_end_matches(|c| c != ' '), &["line 32", "one is missing"]);
}

#[test]
fn coordinates_that_are_not_finite_are_refused() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut bytes = binary(b"", &cube());
        bytes[84 + 3 * 50 + 20..][..4].copy_from_slice(&bad.to_le_bytes());
        check(bytes, &["triangle 4 has a coordinate that is not a finite number", "byte 234"]);
    }
    for bad in ["NaN", "inf", "1e39"] {
        let text = ascii("cube", &cube());
        let lines: Vec<&str> = text.lines().collect();
        let bad = format!("vertex 0 {bad} 0");
        let text = [&lines[..24], &[&bad], &lines[25..]].concat().join("\n");
        check(text, &["triangle 4 has a coordinate that is not a finite number", "line 23"]);
    }
}

#[test]
fn other_formats_are_recognised() {
    let iges = format!("{:<72}S      1\n{:<72}G      1\n", "Exported part", "1H,,1H;,4Hpart;");
    let cases: [(&[u8], &str); 9] = [
        (b"PK\x03\x04\x14\x00\x06\x003D/3dmodel.model", "the 3MF file cannot be read"),
        (b"\x1f\x8b\x08\x00\x00\x00\x00\x00", "the gzip file cannot be read: it is damaged"),
        (b"ISO-10303-21;\nHEADER;\n", "a STEP file"),
        (iges.as_bytes(), "an IGES file"),
        (b"ply\nformat ascii 1.0\n", "the PLY file cannot be read"),
        (b"ply\r\nformat ascii 1.0\r\n", "the PLY file cannot be read"),
        (b"v 0 0 0\nv 1 0 0\nf 1 2 3\n", "the OBJ file cannot be read"),
        (b"# exported\no part\nv 0 0 0\n", "no triangle with an area"),
        (b"# exported\nmtllib part.mtl\nusemtl steel\n", "not an STL file"),
    ];
    for (bytes, name) in cases {
        check(bytes, &[name]);
        // Long enough for a triangle count at byte 80.
        check([bytes, &[b' '; 500]].concat(), &[name]);
    }
}

#[test]
fn what_is_no_model_is_refused() {
    check("The quick brown fox jumps over the lazy dog.", &["not an STL file", "44 bytes"]);
    check("Lorem ipsum dolor sit amet. ".repeat(40), &["not an STL file", "no \"facet\" lines"]);
    check("solid ground is what this text is about, ".repeat(5), &["not an STL file", "holds no \"facet\""]);
    let mut noise = 1_u32;
    let mut random = || {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (noise >> 24) as u8
    };
    for length in [10, 84, 85, 200, 5000] {
        check((0..length).map(|_| random()).collect::<Vec<u8>>(), &["not an STL file"]);
    }
    check([0; 83], &["not an STL file"]);
}

#[test]
fn a_file_of_degenerate_triangles_is_refused() {
    let point: Vec<Facet> = cube().iter().map(|&[a, _, c]| [a, a, c]).collect();
    check(binary(b"", &point), &["no triangle with an area", "12 read"]);
    check(ascii("", &point), &["no triangle with an area", "12 read"]);
    check(binary(b"", &[]), &["no triangle with an area"]);
}

#[test]
fn a_file_of_triangles_on_a_line_is_refused() {
    let line: Vec<Facet> = cube().iter().map(|&[a, b, _]| [a, (a + b) / 2.0, b]).collect();
    check(binary(b"", &line), &["no triangle with an area", "12 read"]);
}

/// Imports and, if there is a mesh within reach, cuts it: whatever comes out, nothing may panic.
fn survives(bytes: &[u8]) -> Result<(), TestCaseError> {
    let Ok(import) = import(bytes, &Task::new()) else { return Ok(()) };
    let mut mesh = import.mesh;
    mesh.place(1.0, glam::DVec3::ZERO);
    let height = mesh.size().z / 5.0;
    if mesh.check_reach().is_ok() && height > 0.0 {
        let options = SliceOptions { layer_height: height, close_gap: 0.5, simplify: 0.01 };
        let layers = Slicer::new(&mesh, options, &Task::new()).unwrap().all(&Task::new()).unwrap();
        prop_assert!(layers.iter().all(|l| l.area().is_finite() && l.area() >= 0.0));
    }
    Ok(())
}

#[test]
fn random_bytes_never_panic() {
    let bytes = prop::collection::vec(any::<u8>(), 0..1500);
    runner(400).run(&bytes, |bytes| survives(&bytes)).unwrap();
    runner(200).run(&bytes, |bytes| survives(&[b"solid ", &bytes[..]].concat())).unwrap();
    // Records of random bits behind a count that is right.
    let records = bytes.prop_map(|b| {
        let count = b.len() / 50;
        [&[0; 80][..], &(count as u32).to_le_bytes(), &b[..count * 50]].concat()
    });
    runner(200).run(&records, |bytes| survives(&bytes)).unwrap();
}

#[test]
fn random_words_of_the_format_never_panic() {
    const WORDS: &[&str] =
        &["solid", "facet", "normal", "outer loop", "vertex", "endfacet", "endloop", "\n", "1", "-2e3", "nan", "x"];
    let text = prop::collection::vec(prop::sample::select(WORDS), 0..200);
    runner(300).run(&text, |words| survives(format!("solid\n{}", words.join(" ")).as_bytes())).unwrap();
}

#[test]
fn damaged_files_never_panic() {
    let two = [cube(), flipped(&cuboid([2.0; 3], [8.0; 3]))].concat();
    let bases =
        [binary(b"solid", &two), ascii("two", &two).into_bytes(), ascii("two", &cube()).to_uppercase().into_bytes()];
    let damage = (0..3_usize, prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..12), 0.0..1.5);
    runner(600)
        .run(&damage, |(base, changes, cut)| {
            let mut bytes = bases[base].clone();
            for (index, byte) in changes {
                let index = index.index(bytes.len());
                bytes[index] = byte;
            }
            let length = (bytes.len() as f64 * f64::min(cut, 1.0)) as usize;
            survives(&bytes[..length])
        })
        .unwrap();
}

/// A packed file is read as what it holds; one that unfolds without end is refused before it fills the memory.
#[test]
fn a_file_packed_by_gzip_is_read_as_it_is() {
    let packed = |bytes: &[u8]| {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        std::io::Write::write_all(&mut encoder, bytes).unwrap();
        encoder.finish().unwrap()
    };
    let obj = b"v 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    let [plain, unpacked] = [obj.to_vec(), packed(obj)].map(|bytes| import(&bytes, &Task::new()).unwrap());
    assert_eq!((plain.mesh.triangles, plain.mesh.vertices), (unpacked.mesh.triangles, unpacked.mesh.vertices));
    let bomb = packed(&vec![b' '; 80 << 20]);
    check(&bomb, &["the gzip file cannot be read", "unpacks to more than 64 MB"]);
    check(&packed(obj)[..30], &["the gzip file cannot be read", "damaged"]);
}

/// Some programs write edges as faces of two corners.
#[test]
fn faces_of_two_corners_are_counted_and_left_out() {
    let obj = b"v 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\nf 1 3 2\nf 1 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 4 3\n";
    let import = import(obj, &Task::new()).unwrap();
    assert_eq!((import.repair.triangles_read, import.repair.degenerate, import.repair.triangles), (6, 2, 4));
    assert!((import.mesh.volume() - 4500.0).abs() < 1e-9);
}
