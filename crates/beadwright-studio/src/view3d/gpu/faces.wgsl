// Where the section cuts a bead: a rectangle on the plane; only what is inside the bead is drawn.

struct FaceVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) colour: vec3<f32>,
    @location(1) at: vec3<f32>,
    // The two ends of the centre line, with half the width and half the height.
    @location(2) @interpolate(flat) end_a: vec4<f32>,
    @location(3) @interpolate(flat) end_b: vec4<f32>,
    // The direction out of its layer.
    @location(4) @interpolate(flat) up: vec3<f32>,
}

@vertex
fn face(
    @builtin(vertex_index) vertex: u32,
    @location(0) from_width: vec4<f32>,
    @location(1) to_height: vec4<f32>,
    @location(4) value: f32,
    @location(5) packed_up: u32,
) -> FaceVertex {
    let half = vec2(abs(from_width.w), abs(to_height.w) * globals.ground.w) * 0.5;
    let up = turned_up(packed_up);
    let a = from_width.xyz - up * half.y;
    let b = to_height.xyz - up * half.y;
    // How far the bead reaches from its centre line, along the axes and along the normal of the plane.
    let room = sqrt(mix(vec3(half.x * half.x), vec3(half.y * half.y), up * up));
    let normal = globals.section.xyz;
    let reach = dot(room, abs(normal));

    // The stretch of the centre line that is near enough to the plane.
    let begin = dot(normal, a) - globals.section.w;
    let run = dot(normal, b) - globals.section.w - begin;
    var stretch = vec2(0.0, 1.0);
    if abs(run) > 1e-6 {
        let ends = vec2(-reach - begin, reach - begin) / run;
        stretch = clamp(vec2(min(ends.x, ends.y), max(ends.x, ends.y)), vec2(0.0), vec2(1.0));
    }
    let missed = select(stretch.x >= stretch.y, abs(begin) > reach, abs(run) <= 1e-6);
    let p = mix(a, b, stretch.x);
    let q = mix(a, b, stretch.y);

    let place = vec2(f32(vertex & 1u), f32(vertex >> 1u));
    let upright = select(vec3(0.0, place), vec3(place.x, 0.0, place.y), abs(normal.y) > 0.5);
    let part = select(upright, vec3(place, 0.0), abs(normal.z) > 0.5);
    let on_plane = mix(min(p, q) - room, max(p, q) + room, part);
    var out: FaceVertex;
    out.at = normal * globals.section.w + (vec3(1.0) - abs(normal)) * on_plane;
    out.clip = select(globals.clip_from_world * vec4(out.at, 1.0), vec4(0.0, 0.0, 0.0, 1.0), missed);
    out.colour = bead_colour(value);
    out.end_a = vec4(a, half.x);
    out.end_b = vec4(b, half.y);
    out.up = up;
    return out;
}

// How far a point is from the centre line: 1 on the surface.
fn from_centre(in: FaceVertex) -> f32 {
    // Stretched along the height so that the ellipse is a circle.
    let more = in.end_a.w / in.end_b.w - 1.0;
    var way = in.end_b.xyz - in.end_a.xyz;
    way += in.up * (more * dot(way, in.up));
    var off = in.at - in.end_a.xyz;
    off += in.up * (more * dot(off, in.up));
    let part = clamp(dot(off, way) / max(dot(way, way), 1e-12), 0.0, 1.0);
    return length(off - way * part) / in.end_a.w;
}

struct Face {
    @location(0) colour: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn cut_face(in: FaceVertex) -> Face {
    let off = from_centre(in);
    if off > 1.0 {
        discard;
    }
    // Beads overlap: each point belongs to the bead that it is deepest in.
    let depth = in.clip.z * (1.0 + globals.screen.w * (1.0 - off));
    return Face(vec4(in.colour * mix(0.85, 0.45, smoothstep(0.84, 0.94, off)), 1.0), depth);
}
