// Bevy's material with a plain weave: threads that bulge, and gaps between them through which light passes.

#import bevy_pbr::{
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions::alpha_discard,
    pbr_types::PbrInput,
}

#ifdef PREPASS_PIPELINE
#import bevy_pbr::{
    prepass_io::{FragmentOutput, VertexOutput},
    pbr_deferred_functions::deferred_output,
}
#else
#import bevy_pbr::{
    forward_io::{FragmentOutput, VertexOutput},
    pbr_functions::{apply_pbr_lighting, main_pass_post_lighting_processing},
    pbr_types::STANDARD_MATERIAL_FLAGS_UNLIT_BIT,
}
#endif

struct Weave {
    threads: vec2<f32>,
    relief: f32,
    gaps: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> weave: Weave;

const PI: f32 = 3.1415927;

// Threads a pixel from which the weave begins to fade, and at which only its mean remains: the sampling theorem's limit.
const FADE: vec2<f32> = vec2(0.2, 0.5);

// Mean height of the threads, 1.5/π, and mean of the gaps, the fourth power of the rest.
const MEAN_HEIGHT: f32 = 0.477;
const MEAN_GAP: f32 = 0.16;

// Part of the skylight that reaches the bottom of the weave.
const BOTTOM_LIGHT: f32 = 0.4;

// Slope of the upper threads along both texture coordinates, and their height, from 0 to 1.
fn threads_at(at: vec2<f32>) -> vec3<f32> {
    let cell = floor(at);
    let from_middle = at - cell - 0.5;
    // In every second cell the thread along v lies above the one along u.
    let along_v = fract(0.5 * (cell.x + cell.y)) < 0.25;
    let across = select(from_middle.y, from_middle.x, along_v);
    let along = select(from_middle.x, from_middle.y, along_v);
    let arch = 0.75 + 0.25 * cos(2.0 * PI * along);
    let slope_across = -PI * sin(PI * across) * arch;
    let slope_along = -0.5 * PI * sin(2.0 * PI * along) * cos(PI * across);
    let slope = select(vec2(slope_along, slope_across), vec2(slope_across, slope_along), along_v);
    return vec3(slope, cos(PI * across) * arch);
}

#ifdef VERTEX_UVS_A
fn add_weave(pbr_input: ptr<function, PbrInput>, in: VertexOutput) {
    let at = in.uv * weave.threads;
    let footprint = fwidth(at);
    let shown = 1.0 - smoothstep(FADE.x, FADE.y, max(footprint.x, footprint.y));
    let thread = threads_at(at);
    let height = mix(MEAN_HEIGHT, thread.z, shown);

    // Directions in which the texture coordinates grow (Mikkelsen 2010), with the faces' own normals.
    let normal = (*pbr_input).N;
    let dx = dpdx(in.world_position.xyz);
    let dy = dpdy(in.world_position.xyz);
    let du = vec2(dpdx(at.x), dpdy(at.x));
    let dv = vec2(dpdx(at.y), dpdy(at.y));
    let across_dx = cross(normal, dx);
    let across_dy = cross(dy, normal);
    let orientation = sign(dot(dx, across_dy));
    let along_u = across_dy * du.x + across_dx * du.y;
    let along_v = across_dy * dv.x + across_dx * dv.y;
    // A triangle that is seen exactly edge-on has none.
    let lengths = max(vec2(length(along_u), length(along_v)), vec2(1e-20));
    let gradient = thread.x * along_u / lengths.x + thread.y * along_v / lengths.y;
    (*pbr_input).N = normalize(normal - orientation * shown * weave.relief * gradient);

    let covered = mix(BOTTOM_LIGHT, 1.0, height) / mix(BOTTOM_LIGHT, 1.0, MEAN_HEIGHT);
    (*pbr_input).material.base_color = vec4(
        (*pbr_input).material.base_color.rgb * mix(1.0, covered, min(4.0 * weave.relief, 1.0)),
        (*pbr_input).material.base_color.a,
    );
    let gap = mix(MEAN_GAP, pow(1.0 - thread.z, 4.0), shown);
    let transmission = (*pbr_input).material.diffuse_transmission;
    (*pbr_input).material.diffuse_transmission = mix(transmission, 1.0, weave.gaps * gap);
}
#endif

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    var pbr_input = pbr_input_from_standard_material(in, is_front);
    pbr_input.material.base_color = alpha_discard(pbr_input.material, pbr_input.material.base_color);
#ifdef VERTEX_UVS_A
    add_weave(&pbr_input, in);
#endif
#ifdef PREPASS_PIPELINE
    return deferred_output(in, pbr_input);
#else
    var out: FragmentOutput;
    if (pbr_input.material.flags & STANDARD_MATERIAL_FLAGS_UNLIT_BIT) == 0u {
        out.color = apply_pbr_lighting(pbr_input);
    } else {
        out.color = pbr_input.material.base_color;
    }
    out.color = main_pass_post_lighting_processing(pbr_input, out.color);
    return out;
#endif
}
