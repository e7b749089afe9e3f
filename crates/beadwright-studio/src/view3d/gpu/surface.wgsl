// The model and the torch: flat triangles, their normals found from neighbouring pixels.

struct SurfaceVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) at: vec3<f32>,
    @location(1) @interpolate(flat) role: u32,
}

@vertex
fn surface(@location(0) at: vec3<f32>) -> SurfaceVertex {
    return SurfaceVertex(globals.clip_from_world * vec4(at, 1.0), at, 6u);
}

@vertex
fn solid(@location(0) at: vec3<f32>, @location(1) role: u32) -> SurfaceVertex {
    return SurfaceVertex(globals.clip_from_world * vec4(at, 1.0), at, role);
}

fn facing(at: vec3<f32>) -> vec3<f32> {
    let normal = normalize(cross(dpdx(at), dpdy(at)));
    return select(-normal, normal, dot(normal, to_viewer(at)) > 0.0);
}

@fragment
fn opaque(in: SurfaceVertex) -> @location(0) vec4<f32> {
    return vec4(shaded(globals.roles[in.role].rgb, facing(in.at)), 1.0);
}

// Where the model is cut, its inside is seen: in one colour, as if it were solid.
@fragment
fn cut_opaque(in: SurfaceVertex, @builtin(front_facing) outside: bool) -> @location(0) vec4<f32> {
    let lit = shaded(globals.roles[in.role].rgb, facing(in.at));
    if is_cut(in.at) {
        discard;
    }
    return vec4(select(globals.roles[10].rgb, lit, outside), 1.0);
}

@fragment
fn cut_glass(in: SurfaceVertex) -> @location(0) vec4<f32> {
    let colour = clear(in);
    if is_cut(in.at) {
        discard;
    }
    return colour;
}

@fragment
fn glass(in: SurfaceVertex) -> @location(0) vec4<f32> {
    return clear(in);
}

// Clearer where it is seen face-on, as glass is.
fn clear(in: SurfaceVertex) -> vec4<f32> {
    let normal = facing(in.at);
    let square = abs(dot(normal, to_viewer(in.at)));
    let alpha = mix(0.42, 0.10, square);
    return vec4(shaded(globals.roles[in.role].rgb, normal) * alpha, alpha);
}
