// Lines, dots, and the grid on the ground.

struct MarkVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) colour: vec4<f32>,
    @location(1) place: vec2<f32>,
    @location(2) at: vec3<f32>,
}

@vertex
fn line(@location(0) at: vec3<f32>, @location(1) role: u32) -> MarkVertex {
    var out: MarkVertex;
    out.clip = nudged(globals.clip_from_world * vec4(at, 1.0), 1.0);
    out.colour = globals.roles[role];
    out.at = at;
    return out;
}

fn ink(in: MarkVertex) -> vec4<f32> {
    return vec4(in.colour.rgb * in.colour.a, in.colour.a);
}

@fragment
fn line_colour(in: MarkVertex) -> @location(0) vec4<f32> {
    return ink(in);
}

@fragment
fn cut_line(in: MarkVertex) -> @location(0) vec4<f32> {
    if is_cut(in.at) {
        discard;
    }
    return ink(in);
}

// A round dot of a few pixels: it lies on the bead, or faces a viewer who looks from the side.
@vertex
fn dot_mark(
    @builtin(vertex_index) vertex: u32,
    @location(0) at: vec3<f32>,
    @location(1) role: u32,
    @location(2) packed_up: u32,
) -> MarkVertex {
    const RADIUS: f32 = 6.5;
    let place = vec2(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0;
    let viewer = to_viewer(at);
    let up = turned_up(packed_up);
    let normal = normalize(mix(viewer, up, smoothstep(0.0, 0.4, dot(viewer, up))));
    let helper = select(vec3(0.0, 0.0, 1.0), vec3(0.0, 1.0, 0.0), abs(normal.z) > 0.9);
    let i = normalize(cross(helper, normal));
    let offset = (i * place.x + cross(normal, i) * place.y) * (RADIUS * pixel_at(at));
    var out: MarkVertex;
    out.clip = nudged(globals.clip_from_world * vec4(at + normal * 0.3 + offset, 1.0), 2.0);
    out.colour = globals.roles[role];
    out.place = place;
    out.at = at;
    return out;
}

@fragment
fn dot_colour(in: MarkVertex) -> @location(0) vec4<f32> {
    return disc(in);
}

fn disc(in: MarkVertex) -> vec4<f32> {
    let r = length(in.place);
    if r > 1.0 {
        discard;
    }
    return vec4(select(in.colour.rgb, vec3(1.0), r > 0.72), 1.0);
}

@fragment
fn cut_dot(in: MarkVertex) -> @location(0) vec4<f32> {
    if is_cut(in.at) {
        discard;
    }
    return disc(in);
}

struct GroundVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) at: vec2<f32>,
}

@vertex
fn ground(@builtin(vertex_index) vertex: u32) -> GroundVertex {
    let place = vec2(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0;
    var out: GroundVertex;
    out.at = globals.ground.xy + place * globals.ground.z;
    out.clip = globals.clip_from_world * vec4(out.at, 0.0, 1.0);
    return out;
}

// How much of a pixel the lines of a grid cover.
fn grid(at: vec2<f32>, pitch: f32, pixel: vec2<f32>) -> f32 {
    let off = abs(fract(at / pitch - 0.5) - 0.5) * pitch / pixel;
    let line = 1.0 - min(off, vec2(1.0));
    // Lines that come too close are a haze, and then nothing.
    let apart = smoothstep(vec2(3.0), vec2(12.0), pitch / pixel);
    return max(line.x * apart.x, line.y * apart.y);
}

@fragment
fn ground_colour(in: GroundVertex) -> @location(0) vec4<f32> {
    let pixel = max(fwidth(in.at), vec2(1e-6));
    let fade = 1.0 - smoothstep(0.55, 1.0, distance(in.at, globals.ground.xy) / globals.ground.z);
    let lines = max(0.38 * grid(in.at, 10.0, pixel), grid(in.at, 100.0, pixel));
    let axes = 1.0 - min(abs(in.at) / pixel, vec2(1.0));
    let base = globals.roles[7];
    var colour = mix(base.rgb, vec3(0.30, 0.66, 0.32), axes.x * 0.8);
    colour = mix(colour, vec3(0.80, 0.28, 0.26), axes.y * 0.8);
    let alpha = max(lines * base.a, max(axes.x, axes.y) * 0.6) * fade;
    return vec4(colour * alpha, alpha);
}

@vertex
fn floor(@builtin(vertex_index) vertex: u32) -> GroundVertex {
    let place = vec2(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0;
    let frame = globals.floor;
    var out: GroundVertex;
    out.at = place * frame[0].w;
    let world = frame[3].xyz + frame[0].xyz * out.at.x + frame[1].xyz * out.at.y;
    out.clip = globals.clip_from_world * vec4(world, 1.0);
    return out;
}

@fragment
fn floor_colour(in: GroundVertex) -> @location(0) vec4<f32> {
    let pixel = max(fwidth(in.at), vec2(1e-6));
    let fade = 1.0 - smoothstep(0.5, 1.0, length(in.at) / globals.floor[0].w);
    let lines = max(0.4 * grid(in.at, 100.0, pixel), grid(in.at, 1000.0, pixel)) * globals.roles[7].a;
    let base = globals.roles[13];
    let colour = mix(base.rgb, globals.roles[7].rgb, lines);
    let alpha = base.a * fade;
    return vec4(colour * alpha, alpha);
}
