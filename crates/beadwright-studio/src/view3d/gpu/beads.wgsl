// Beads: tubes with the cross-section of an ellipse, seen as ribbons that face the viewer.
//
// A ribbon goes through real points of the ellipse: its outline at both sides and the nearest point in the middle (more
// between them where there are more strips). So neighbouring beads cut each other where the tubes do, and depths never
// fight. Ends and sharp corners are ellipsoids, drawn as a fan in the same way. Normals are those of the true surface.

struct BeadVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) colour: vec3<f32>,
    // Where on the disc that the viewer sees: length 1 on the outline.
    @location(1) place: vec2<f32>,
    // The share of the normal that `place` gives, and the normal in the middle.
    @location(2) side: vec3<f32>,
    @location(3) front: vec3<f32>,
    @location(4) at: vec3<f32>,
}

fn bead_colour(value: f32) -> vec3<f32> {
    let part = clamp((value - globals.values.x) * globals.values.y, 0.0, 1.0);
    let mapped = textureLoad(colour_map, vec2(i32(part * 255.0 + 0.5), 0), 0).rgb;
    let colour = select(mapped, globals.missing.rgb, value < -1e30);
    return mix(colour, globals.accent.rgb, globals.accent.a);
}

// Direction from a to b; x for a point.
fn way(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let d = b - a;
    let l = length(d);
    return select(vec3(1.0, 0.0, 0.0), d / l, l > 1e-6);
}

// Three perpendicular directions, the third one given (Duff et al. 2017); the axes themselves for z.
fn frame(up: vec3<f32>) -> mat3x3<f32> {
    let side = select(-1.0, 1.0, up.z >= 0.0);
    let a = -1.0 / (side + up.z);
    let b = up.x * up.y * a;
    return mat3x3(
        vec3(1.0 + side * up.x * up.x * a, side * b, -side * up.x),
        vec3(b, side + up.y * up.y * a, -up.y),
        up,
    );
}

// Fades the shading of beads that are too fine to be seen as round, which would only flicker.
fn roundness(half_width: f32, pixel: f32) -> f32 {
    return smoothstep(0.4, 2.0, half_width / pixel);
}

@vertex
fn ribbon(
    @builtin(vertex_index) vertex: u32,
    @location(0) from_width: vec4<f32>,
    @location(1) to_height: vec4<f32>,
    @location(2) before: vec3<f32>,
    @location(3) after: vec3<f32>,
    @location(4) value: f32,
    @location(5) up_here: u32,
    @location(6) up_before: u32,
    @location(7) up_after: u32,
) -> BeadVertex {
    let at_end = (vertex & 1u) == 1u;
    let across = f32(vertex >> 1u) * globals.values.z - 1.0;
    let along = way(from_width.xyz, to_height.xyz);
    let top = select(from_width.xyz, to_height.xyz, at_end);

    // Both segments of a mitred joint find the same cross-section: the one halfway between them.
    var other = along;
    var up_other = up_here;
    if at_end && to_height.w < 0.0 {
        other = way(top, after);
        up_other = up_after;
    } else if !at_end && from_width.w < 0.0 {
        other = way(before, top);
        up_other = up_before;
    }
    var up = vec3(0.0, 0.0, 1.0);
    if (up_here | up_other) != 0u {
        up = normalize(turned_up(up_here) + turned_up(up_other));
    }
    let axis = normalize(along + other);
    var half_width = abs(from_width.w) * 0.5 / dot(axis, along);
    var half_height = abs(to_height.w) * 0.5 * globals.ground.w;
    let centre = top - up * half_height;

    let level = cross(up, axis);
    let n = select(vec3(1.0, 0.0, 0.0), level / length(level), dot(level, level) > 1e-8);
    let z = cross(axis, n);
    let viewer = to_viewer(centre);
    let s = cross(axis, viewer);
    let sideways = select(n, normalize(s), dot(s, s) > 1e-8);

    // In the plane of the cross-section, stretched so that the ellipse is a circle.
    let outline = vec2(half_width * dot(sideways, n), half_height * dot(sideways, z));
    let reach = length(outline);
    let edge = outline / reach;
    let turned = vec2(-edge.y, edge.x);
    let nearer = half_width * dot(viewer, n) * turned.x + half_height * dot(viewer, z) * turned.y;
    let middle = select(-turned, turned, nearer >= 0.0);

    // Never finer than a pixel.
    let pixel = pixel_at(centre);
    let widened = max(1.0, 0.6 * pixel / reach);
    half_width = half_width * widened;
    half_height = half_height * widened;

    let lift = sqrt(max(0.0, 1.0 - across * across));
    let spot = edge * across + middle * lift;
    let world = centre + n * (half_width * spot.x) + z * (half_height * spot.y);

    // Real beads are so flat that the eye would not see them as round.
    let flat_width = mix(half_width, half_height, globals.values.w);
    let round = roundness(reach, pixel);
    var out: BeadVertex;
    out.clip = globals.clip_from_world * vec4(world, 1.0);
    out.colour = bead_colour(value);
    out.place = vec2(across * round, 0.0);
    out.side = (n * (edge.x / flat_width) + z * (edge.y / half_height)) * half_height * across * round;
    out.front = (n * (middle.x / flat_width) + z * (middle.y / half_height)) * half_height;
    out.at = world;
    return out;
}

@vertex
fn cap(
    @builtin(vertex_index) vertex: u32,
    @location(0) top: vec3<f32>,
    @location(1) size: vec2<f32>,
    @location(2) value: f32,
    @location(3) up: u32,
) -> BeadVertex {
    // The vertices of a fan: the lower byte is the angle in steps of 1.5°, the next one the ring.
    var half = vec3(size.x, size.x, size.y) * 0.5;
    // From where the layer is level to where it lies.
    let turn = frame(turned_up(up));
    let centre = top - turn[2] * half.z;
    let viewer = to_viewer(centre) * turn;
    let front = normalize(viewer / half);
    let helper = select(vec3(0.0, 0.0, 1.0), vec3(0.0, 1.0, 0.0), abs(front.z) > 0.9);
    let i = normalize(cross(helper, front));
    let j = cross(front, i);
    let pixel = pixel_at(centre);
    let reach = half.x;
    half = half * max(1.0, 0.6 * pixel / reach);

    let angle = f32(vertex & 255u) * radians(1.5);
    let place = vec2(cos(angle), sin(angle)) * (f32(vertex >> 8u) * 0.5);
    let rim = i * place.x + j * place.y;
    let spot = rim + front * sqrt(max(0.0, 1.0 - dot(place, place)));

    let flat_width = mix(half.x, half.z, globals.values.w);
    let shape = vec3(flat_width, flat_width, half.z) / half.z;
    let round = roundness(reach, pixel);
    var out: BeadVertex;
    out.at = centre + turn * (half * spot);
    out.clip = globals.clip_from_world * vec4(out.at, 1.0);
    out.colour = bead_colour(value);
    out.place = place * round;
    out.side = turn * (rim / shape * round);
    out.front = turn * (front / shape);
    return out;
}

fn lit(in: BeadVertex) -> vec4<f32> {
    let lift = sqrt(max(0.0, 1.0 - dot(in.place, in.place)));
    let normal = normalize(in.side + in.front * lift);
    return vec4(shaded(in.colour, normal), 1.0);
}

@fragment
fn bead(in: BeadVertex) -> @location(0) vec4<f32> {
    return lit(in);
}

@fragment
fn cut_bead(in: BeadVertex) -> @location(0) vec4<f32> {
    if is_cut(in.at) {
        discard;
    }
    return lit(in);
}
