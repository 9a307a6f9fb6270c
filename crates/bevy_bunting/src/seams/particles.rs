//! The particles of a level along a side of a seam.

use bevy_math::Vec3;
use bunting_solver::Fabric;

use crate::fabric::levels::ClothLevels;
use crate::seams::error::SeamError;

/// Distance from a run within which particles are on it, in particles' spacings. Smaller: those of coarse levels on curved edges are left
/// out. Larger: those of the next row are sewn, too.
const BESIDE: f32 = 0.2;

/// A particle along a run, and how far along it is, m.
pub(super) type OnRun = (u32, f32);

/// The particles of a level along the straight ways between vertices, in their order. They belong to the piece of cloth of the first
/// vertex. Where there are none, it is the one that is nearest to the beginning.
pub(super) fn along(
    levels: &ClothLevels,
    level: usize,
    vertices: &[u32],
) -> Result<Vec<OnRun>, SeamError> {
    let finest = levels.fabric(0).rest_positions();
    let place = |&vertex: &u32| {
        levels.vertex_position(0, vertex, finest).ok_or(SeamError::Vertex { vertex })
    };
    let way = vertices.iter().map(place).collect::<Result<Vec<Vec3>, SeamError>>()?;
    let (Some(&vertex), Some(&start)) = (vertices.first(), way.first()) else {
        return Ok(Vec::new());
    };
    let fabric = levels.fabric(level);
    let rest = fabric.rest_positions();
    let nearest = |at: Vec3| {
        let distance = |particle: &usize| rest[*particle].distance_squared(at);
        (0..rest.len()).min_by(|one, other| distance(one).total_cmp(&distance(other)))
    };
    let Some(first) = levels.particle(level, vertex).or_else(|| nearest(start)) else {
        return Ok(Vec::new());
    };
    let reach = BESIDE * (fabric.area() / rest.len() as f32).sqrt();
    let in_piece = piece(fabric, first);
    let mut found: Vec<OnRun> = Vec::new();
    for (particle, &at) in rest.iter().enumerate().filter(|(particle, _)| in_piece[*particle]) {
        let (distance, length) = place_on(&way, at);
        if distance <= reach {
            found.push((particle as u32, length));
        }
    }
    if found.is_empty() {
        found.push((first as u32, 0.0));
    }
    found.sort_by(|one, other| one.1.total_cmp(&other.1));
    Ok(found)
}

/// How far a place is from a way, and how far along it the nearest point is, m.
fn place_on(way: &[Vec3], at: Vec3) -> (f32, f32) {
    let mut best = (at.distance(way[0]), 0.0);
    let mut length = 0.0;
    for ends in way.windows(2) {
        let along = ends[1] - ends[0];
        let part = (at - ends[0]).dot(along) / along.length_squared().max(f32::MIN_POSITIVE);
        let part = part.clamp(0.0, 1.0);
        let distance = at.distance(ends[0] + along * part);
        if distance < best.0 {
            best = (distance, length + part * along.length());
        }
        length += along.length();
    }
    best
}

/// For each particle, whether links join it to the first one.
fn piece(fabric: &Fabric, first: usize) -> Vec<bool> {
    let mut near: Vec<Vec<u32>> = vec![Vec::new(); fabric.particle_count()];
    for link in fabric.links() {
        let [one, other] = link.particles;
        near[one as usize].push(other);
        near[other as usize].push(one);
    }
    let mut is_in = vec![false; near.len()];
    is_in[first] = true;
    let mut ends = vec![first];
    while let Some(particle) = ends.pop() {
        for &next in &near[particle] {
            if !core::mem::replace(&mut is_in[next as usize], true) {
                ends.push(next as usize);
            }
        }
    }
    is_in
}
