//! An inextensible sheet without bending between two level edges.

use super::root::bisect;

/// Shape of a hanging sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Catenary {
    /// Parameter a: the horizontal tension over the weight per length, m.
    pub parameter: f64,
    /// Depth of the lowest point under the edges, m.
    pub sag: f64,
    /// Slope at the edges, rad.
    pub end_angle: f64,
}

impl Catenary {
    /// The sheet of length L between edges at a distance S: 2a sinh(S/2a) = L.
    #[must_use]
    pub fn new(span: f64, length: f64) -> Self {
        // With x = S/2a the condition is sinh(x)/x = L/S, whose left side grows from 1.
        let x = bisect(1e-9, 100.0, |x| x.sinh() / x > length / span);
        let parameter = span / (2.0 * x);
        Self { parameter, sag: parameter * (x.cosh() - 1.0), end_angle: x.sinh().atan() }
    }

    /// Tension at the edges per metre of width, N/m, of a sheet that weighs `weight` N/m².
    #[must_use]
    pub fn largest_tension(&self, weight: f64) -> f64 {
        weight * self.parameter / self.end_angle.cos()
    }
}

/// Sag in metres of a chain of N = `links` equal links with equal masses, exact: tan θₖ = (k − (N+1)/2)/H
/// with Σ cos θₖ = N S/L.
#[must_use]
pub fn chain_sag(links: usize, span: f64, length: f64) -> f64 {
    sag_of_chain(&vec![1.0; links - 1], span, length)
}

/// Sag in metres of a chain of equal links with these masses between them, symmetric about the middle.
#[must_use]
pub fn sag_of_chain(masses: &[f64], span: f64, length: f64) -> f64 {
    let links = masses.len() + 1;
    // Each end carries half of the weight; a link carries this half minus the weight of the masses above it.
    let half = 0.5 * masses.iter().sum::<f64>();
    let mut loads = vec![-half];
    for mass in masses {
        loads.push(loads[loads.len() - 1] + mass);
    }
    let target = links as f64 * span / length;
    let spanned = |pull: f64| loads.iter().map(|load| pull / load.hypot(pull)).sum::<f64>();
    let pull = bisect(1e-9, 1e6, |pull| spanned(pull) > target);
    let drop: f64 = loads.iter().map(|load| (-load).max(0.0) / load.hypot(pull)).sum();
    drop * length / links as f64
}
