//! Measurements of clothes.

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_solver::LinkFamily;

use crate::figure::part::Part;
use crate::limits::{Limit, greatest};
use crate::scenes::wardrobe::garment::Garment;

/// The part of the links whose strain is not greater than what is measured.
const QUANTILE: f32 = 0.99;

/// Names and limits of the values of a piece of clothing: depth in the body, m, and strain.
struct Bounds {
    garment: Garment,
    depth: (&'static str, f32),
    strain: (&'static str, f32),
}

const BOUNDS: [Bounds; 5] = [
    Bounds {
        garment: Garment::Skirt,
        depth: ("depth of the skirt in the body, m", 0.02),
        strain: ("strain of the skirt, 99 %", 0.08),
    },
    Bounds {
        garment: Garment::Shirt,
        depth: ("depth of the shirt in the body, m", 0.01),
        strain: ("strain of the shirt, 99 %", 0.08),
    },
    Bounds {
        garment: Garment::Jacket,
        depth: ("depth of the jacket in the body, m", 0.01),
        strain: ("strain of the jacket, 99 %", 0.08),
    },
    Bounds {
        garment: Garment::Scarf,
        depth: ("depth of the scarf in the body, m", 0.01),
        strain: ("strain of the scarf, 99 %", 0.08),
    },
    // The sides of the cape are in the arms for a tick when it is put on.
    Bounds {
        garment: Garment::Cape,
        depth: ("depth of the cape in the body, m", 0.035),
        strain: ("strain of the cape, 99 %", 0.08),
    },
];

/// Depth in the legs of the skirt as it is shown, m. What is shown is a tick late, and legs that run go so far in it.
const SHOWN: (&str, f32) = ("depth of the skirt as it is shown, m", 0.06);

/// A capsule of the body in the world.
struct Limb {
    ends: [Vec3; 2],
    radius: f32,
    layers: ClothLayers,
}

impl Limb {
    fn depth(&self, at: Vec3) -> f32 {
        let [from, to] = self.ends;
        let along = (at - from).dot(to - from) / from.distance_squared(to);
        (self.radius - at.distance(from.lerp(to, along.clamp(0.0, 1.0)))).max(0.0)
    }
}

/// Depth in the limbs that it touches and strain of each piece of clothing; zero of those that are not worn.
pub fn measure(world: &mut World) -> Vec<Limit> {
    let limbs: Vec<Limb> = world
        .query::<(&Part, &ClothLayers, &GlobalTransform)>()
        .iter(world)
        .map(|(part, &layers, pose)| {
            let half = part.half_length() * Vec3::Y;
            let ends = [-half, half].map(|end| pose.transform_point(end));
            Limb { ends, radius: part.radius, layers }
        })
        .collect();
    let mut clothes = world.query::<(&Garment, &ClothState, &ClothLayers, &GlobalTransform)>();
    let clothes: Vec<_> = clothes.iter(world).collect();
    let limit = |(name, limit), value| Limit { name, value, limit };
    let mut shown = 0.0;
    let mut limits = Vec::new();
    for bounds in &BOUNDS {
        let (mut depth, mut strain) = (0.0, 0.0);
        let worn = clothes.iter().filter(|(garment, ..)| **garment == bounds.garment);
        for &(garment, cloth, layers, frame) in worn {
            let touched = limbs.iter().filter(|limb| layers.touch(limb.layers));
            let touched: Vec<&Limb> = touched.collect();
            depth = depth_in(&touched, cloth, cloth.positions(), frame);
            strain = strain_of(cloth);
            if *garment == Garment::Skirt {
                shown = depth_in(&touched, cloth, cloth.previous_positions(), frame);
            }
        }
        limits.extend([limit(bounds.depth, depth), limit(bounds.strain, strain)]);
    }
    limits.push(limit(SHOWN, shown));
    limits
}

/// Greatest depth of a free particle, and of the middle between two neighbours, m.
fn depth_in(
    limbs: &[&Limb],
    cloth: &ClothState,
    positions: &[Vec3],
    frame: &GlobalTransform,
) -> f32 {
    let Some(fabric) = cloth.fabric() else { return 0.0 };
    let at: Vec<Vec3> = positions.iter().map(|&at| frame.transform_point(at)).collect();
    let is_free = |particle: usize| !fabric.is_pinned(particle);
    let particles = (0..at.len()).filter(|&particle| is_free(particle)).map(|it| at[it]);
    let ends = fabric.links().iter().map(|link| link.particles.map(|end| end as usize));
    let middles = ends.filter(|ends| ends.iter().any(|&end| is_free(end)));
    let middles = middles.map(|[from, to]| at[from].midpoint(at[to]));
    greatest(particles.chain(middles).flat_map(|at| limbs.iter().map(move |limb| limb.depth(at))))
}

/// The strain of warp and weft, at [`QUANTILE`].
fn strain_of(cloth: &ClothState) -> f32 {
    let Some(fabric) = cloth.fabric() else { return 0.0 };
    let is_thread = |family| matches!(family, LinkFamily::Warp | LinkFamily::Weft);
    let strains = fabric.links().iter().zip(cloth.strains());
    let mut strains: Vec<f32> =
        strains.filter(|(link, _)| is_thread(link.family)).map(|(_, strain)| strain).collect();
    if strains.is_empty() {
        return 0.0;
    }
    let rank = ((strains.len() - 1) as f32 * QUANTILE) as usize;
    *strains.select_nth_unstable_by(rank, f32::total_cmp).1
}
