//! Pairs of features whose paths come near one another in a substep.

/// A particle and a triangle: the particle, then the corners.
pub(in crate::contact) type ParticleTriangle = [u32; 4];
/// Two edges: the ends of one, then those of the other.
pub(in crate::contact) type EdgeEdge = [u32; 4];

/// An edge and a triangle.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct EdgeTriangle {
    /// Index of the edge.
    pub index: u32,
    pub edge: [u32; 2],
    pub triangle: [u32; 3],
    /// The patches in which they were found.
    pub patches: [u32; 2],
}

impl EdgeTriangle {
    pub fn particles(&self) -> [u32; 5] {
        let ([a, b], [c, d, e]) = (self.edge, self.triangle);
        [a, b, c, d, e]
    }
}

/// Pairs of features whose paths come near one another in a substep.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Pairs {
    pub particles_triangles: Vec<ParticleTriangle>,
    pub edges_edges: Vec<EdgeEdge>,
    pub edges_triangles: Vec<EdgeTriangle>,
}

impl Pairs {
    pub fn is_empty(&self) -> bool {
        self.particles_triangles.is_empty()
            && self.edges_edges.is_empty()
            && self.edges_triangles.is_empty()
    }

    /// The particles of all pairs, each as often as it is in one.
    pub fn particles(&self) -> impl Iterator<Item = usize> {
        let fours = self.particles_triangles.iter().chain(&self.edges_edges).flatten().copied();
        let fives = self.edges_triangles.iter().flat_map(EdgeTriangle::particles);
        fours.chain(fives).map(|particle| particle as usize)
    }

    /// Drops the pairs of features that seams join, given the particles that they join, in both orders, ascending.
    pub fn drop_sewn(&mut self, sewn: &[[u32; 2]]) {
        if sewn.is_empty() {
            return;
        }
        let are_joined = |one: &[u32], other: &[u32]| {
            let is_joined = |at: u32| other.iter().any(|&to| sewn.binary_search(&[at, to]).is_ok());
            one.iter().any(|&at| is_joined(at))
        };
        self.particles_triangles.retain(|pair| !are_joined(&pair[..1], &pair[1..]));
        self.edges_edges.retain(|pair| !are_joined(&pair[..2], &pair[2..]));
        self.edges_triangles.retain(|pair| !are_joined(&pair.edge, &pair.triangle));
    }

    pub fn clear(&mut self) {
        self.particles_triangles.clear();
        self.edges_edges.clear();
        self.edges_triangles.clear();
    }
}
