// A scan, coloured by how far it lies from the part.

struct ScanVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) at: vec3<f32>,
    // Place in the colour map; below 0 for what has no colour of its own.
    @location(1) part: f32,
}

@vertex
fn scan(@location(0) point: vec4<f32>) -> ScanVertex {
    return ScanVertex(globals.clip_from_world * vec4(point.xyz, 1.0), point.xyz, point.w);
}

// A square of a few pixels that faces the viewer.
@vertex
fn scan_point(@builtin(vertex_index) vertex: u32, @location(0) point: vec4<f32>) -> ScanVertex {
    const RADIUS: f32 = 2.0;
    let place = vec2(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0;
    let viewer = to_viewer(point.xyz);
    let helper = select(vec3(0.0, 0.0, 1.0), vec3(0.0, 1.0, 0.0), abs(viewer.z) > 0.9);
    let i = normalize(cross(helper, viewer));
    let at = point.xyz + (i * place.x + cross(viewer, i) * place.y) * (RADIUS * pixel_at(point.xyz));
    return ScanVertex(globals.clip_from_world * vec4(at, 1.0), at, point.w);
}

fn scan_ink(in: ScanVertex) -> vec4<f32> {
    let mapped = textureLoad(colour_map, vec2(i32(clamp(in.part, 0.0, 1.0) * 255.0 + 0.5), 0), 0).rgb;
    let colour = select(mapped, globals.missing.rgb, in.part < -0.5);
    return vec4(shaded(colour, facing(in.at)), 1.0);
}

@fragment
fn scan_colour(in: ScanVertex) -> @location(0) vec4<f32> {
    return scan_ink(in);
}

@fragment
fn cut_scan(in: ScanVertex) -> @location(0) vec4<f32> {
    let colour = scan_ink(in);
    if is_cut(in.at) {
        discard;
    }
    return colour;
}
