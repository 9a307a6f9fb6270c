//! One particle for each fan of joined triangles.

use std::collections::BTreeMap;

use super::Repairing;
use super::adjacency::Joint;
use crate::fabric::builder::source::FabricBuilder;

/// The vertices of the repaired mesh.
pub(super) struct Fans {
    /// For each vertex, that of the given mesh.
    source: Vec<u32>,
    /// For each vertex, a number that it shares with the vertices of its fan.
    fan: Vec<u32>,
    /// Three vertices for each triangle.
    indices: Vec<u32>,
}

impl Repairing {
    /// Gives each vertex as many copies as there are fans at it.
    pub(super) fn fans(&mut self, joints: &[Joint]) -> Fans {
        let mut sets = Sets::new(3 * self.triangles.len());
        for Joint { triangles, ends } in joints {
            for end in ends {
                let [one, two] = triangles.map(|at| self.corner_at(at, *end));
                sets.join(one, two);
            }
        }
        // The first fan of a vertex keeps it.
        let mut vertices: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        let mut fans_of_particle: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        let corners: Vec<u32> =
            self.triangles.iter().flat_map(|corners| corners.vertices).collect();
        let fans: Vec<u32> = (0..corners.len()).map(|corner| sets.first(corner) as u32).collect();
        for (&vertex, &fan) in corners.iter().zip(&fans) {
            let particle = self.particle_of_vertex[vertex as usize];
            for (key, of) in [(vertex, &mut vertices), (particle, &mut fans_of_particle)] {
                let known = of.entry(key).or_default();
                if !known.contains(&fan) {
                    known.push(fan);
                }
            }
        }
        let firsts = vertices.iter().map(|(&vertex, fans)| (vertex, fans[0]));
        let copies = vertices
            .iter()
            .flat_map(|(&vertex, fans)| fans.iter().skip(1).map(move |&fan| (vertex, fan)));
        let all: Vec<(u32, u32)> = firsts.chain(copies).collect();
        let number: BTreeMap<(u32, u32), u32> = all.iter().copied().zip(0..).collect();
        let indices = corners.iter().zip(&fans).map(|(&vertex, &fan)| number[&(vertex, fan)]);
        let indices = indices.collect();
        let is_split =
            |vertex: &u32| fans_of_particle[&self.particle_of_vertex[*vertex as usize]].len() > 1;
        let (source, fan): (Vec<u32>, Vec<u32>) = all.into_iter().unzip();
        self.report.split_vertices = vertices.keys().copied().filter(is_split).collect();
        self.report.loose = (0..self.positions.len() as u32)
            .filter(|vertex| !vertices.contains_key(vertex))
            .collect();
        self.report.vertices.clone_from(&source);
        Fans { source, fan, indices }
    }

    /// Number of the corner of a triangle at a particle.
    fn corner_at(&self, triangle: usize, particle: u32) -> usize {
        let particles = self.particles(&self.triangles[triangle]);
        3 * triangle + particles.iter().position(|&at| at == particle).unwrap_or(0)
    }
}

impl FabricBuilder {
    /// The same cloth with other vertices.
    pub(super) fn with_vertices(self, fans: &Fans) -> Self {
        let vertices = || fans.source.iter().map(|&vertex| vertex as usize);
        let pinned = (0..).zip(&fans.source).filter(|(_, source)| self.pinned.contains(source));
        Self {
            positions: vertices().map(|vertex| self.positions[vertex]).collect(),
            uv: vertices().filter_map(|vertex| self.uv.get(vertex).copied()).collect(),
            pinned: pinned.map(|(vertex, _)| vertex).collect(),
            indices: fans.indices.clone(),
            merged: Some(fans.fan.clone()),
            regions: self.regions_of(&fans.source),
            ..self
        }
    }
}

/// Disjoint sets, each named after its first member (Tarjan 1975).
struct Sets(Vec<usize>);

impl Sets {
    /// Sets of one member each.
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    /// The first member of the set that has a member.
    fn first(&mut self, member: usize) -> usize {
        let mut at = member;
        while self.0[at] != at {
            self.0[at] = self.0[self.0[at]];
            at = self.0[at];
        }
        at
    }

    /// Joins the sets of two members.
    fn join(&mut self, one: usize, two: usize) {
        let (one, two) = (self.first(one), self.first(two));
        self.0[one.max(two)] = one.min(two);
    }
}
