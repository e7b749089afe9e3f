// What every shader knows. Colours are as on the screen (not linear): egui shows them unchanged.

struct Globals {
    clip_from_world: mat4x4<f32>,
    // Perspective: the eye, w = 1. Parallel lines of sight: the direction to the viewer, w = 0.
    eye: vec4<f32>,
    // Direction to the light.
    light: vec4<f32>,
    // Between light and viewer, for the gloss.
    gloss: vec4<f32>,
    // Direction to the viewer, from the middle of the picture.
    back: vec4<f32>,
    // Width and height in pixels; size of a pixel in mm (at distance 1 in perspective); nudge of depth towards the viewer.
    screen: vec4<f32>,
    // Lowest value of the colour map, 1 / its range, width of a strip of a bead (2 = all of it), roundness.
    values: vec4<f32>,
    // Centre and half size of the ground grid, mm; how many layers a bead stands for.
    ground: vec4<f32>,
    // Colour of beads without a value.
    missing: vec4<f32>,
    // Colour laid over beads, and how much of it.
    accent: vec4<f32>,
    // Normal and offset of the section: what lies beyond is cut away.
    section: vec4<f32>,
    // Straight up in the cell.
    sky: vec4<f32>,
    // The floor: the directions of its lines, out of it, its middle, mm; behind the first, how far it goes.
    floor: mat4x4<f32>,
    // Colours of all that is no bead.
    roles: array<vec4<f32>, 14>,
}

@group(0) @binding(0) var<uniform> globals: Globals;
@group(0) @binding(1) var colour_map: texture_2d<f32>;

// Direction from a point to the viewer.
fn to_viewer(at: vec3<f32>) -> vec3<f32> {
    return normalize(globals.eye.xyz - at * globals.eye.w);
}

// Whether a point is cut away.
fn is_cut(at: vec3<f32>) -> bool {
    return dot(globals.section.xyz, at) > globals.section.w;
}

// The direction out of a layer, unpacked (`packed` in lie.rs).
fn turned_up(up: u32) -> vec3<f32> {
    let flat = unpack2x16snorm(up);
    let z = 1.0 - abs(flat.x) - abs(flat.y);
    let back = max(-z, 0.0);
    return normalize(vec3(flat + select(vec2(back), vec2(-back), flat >= vec2(0.0)), z));
}

// Size of a pixel at a point, mm.
fn pixel_at(at: vec3<f32>) -> f32 {
    return globals.screen.z * select(1.0, distance(globals.eye.xyz, at), globals.eye.w > 0.5);
}

// A point of the clip space, a little nearer to the viewer.
fn nudged(clip: vec4<f32>, steps: f32) -> vec4<f32> {
    return vec4(clip.xy, clip.z * (1.0 + globals.screen.w * steps), clip.w);
}

fn shaded(colour: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let direct = max(dot(normal, globals.light.xyz), 0.0);
    let sky = 0.5 + 0.5 * dot(normal, globals.sky.xyz);
    let gloss = pow(max(dot(normal, globals.gloss.xyz), 0.0), 28.0);
    // A weak light from the viewer, so that nothing that is seen is black.
    let fill = max(dot(normal, globals.back.xyz), 0.0);
    return colour * (0.25 + 0.12 * sky + 0.18 * fill + 0.57 * direct) + vec3(0.10 * gloss);
}
