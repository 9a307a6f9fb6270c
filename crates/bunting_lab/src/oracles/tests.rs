//! Tests of the closed forms against published values.

use std::f64::consts::PI;

use super::{
    Case,
    bending::{Cantilever, LATERAL_BUCKLING, SELF_WEIGHT_COLUMN, column_of_links},
    catenary::{Catenary, chain_sag},
    drag::BroadsideFall,
    dumbbell::{BdfFormula, spin_left},
    free_fall, pendulum, stretch,
};

/// Slightly more than half a unit in the sixth decimal, the last one in the tables.
const SIXTH_DECIMAL: f64 = 0.6e-6;
/// Standard gravity of the tables, m/s².
const G: f64 = 9.81;

#[track_caller]
fn assert_near(measured: f64, expected: f64, tolerance: f64) {
    assert!((measured - expected).abs() <= tolerance, "{measured} is not {expected} ± {tolerance}");
}

#[test]
fn catenaries() {
    let table = [
        (0.5, 0.398194, [0.404535, 0.399684, 0.398558, 0.398285], 0.114820, 77.067),
        (0.8, 0.265438, [0.267680, 0.265991, 0.265576, 0.265472], 0.338202, 55.925),
        (0.9, 0.190709, [0.192201, 0.191079, 0.190801, 0.190732], 0.560094, 41.756),
    ];
    for (span, sag, chains, parameter, degrees) in table {
        let catenary = Catenary::new(span, 1.0);
        assert_near(catenary.sag, sag, SIXTH_DECIMAL);
        assert_near(catenary.parameter, parameter, SIXTH_DECIMAL);
        assert_near(catenary.end_angle.to_degrees(), degrees, 0.6e-3);
        let from_cosh = catenary.parameter * (span / (2.0 * catenary.parameter)).cosh();
        assert_near(catenary.largest_tension(1.0), from_cosh, SIXTH_DECIMAL);
        for (links, sag) in [8, 16, 32, 64].into_iter().zip(chains) {
            assert_near(chain_sag(links, span, 1.0), sag, SIXTH_DECIMAL);
        }
    }
}

#[test]
fn heavy_cantilevers() {
    let table = [
        (0.1, 0.999911, 0.012498),
        (1.0, 0.991246, 0.123471),
        (2.0, 0.966893, 0.238507),
        (5.0, 0.846657, 0.495905),
        (10.0, 0.656354, 0.700200),
        (20.0, 0.445232, 0.829881),
        (50.0, 0.245015, 0.907917),
        (100.0, 0.159223, 0.937524),
        (200.0, 0.107420, 0.956769),
        (500.0, 0.065890, 0.973117),
        (1000.0, 0.045986, 0.981141),
        (1e4, 0.014261, 0.994110),
    ];
    for (gamma, reach, drop) in table {
        let cantilever = Cantilever::new(gamma);
        assert_near(cantilever.reach, reach, SIXTH_DECIMAL);
        assert_near(cantilever.drop, drop, SIXTH_DECIMAL);
    }
    assert_near(Cantilever::new(10.0).aspect(), 1.06680, 1e-5);
}

#[test]
fn swings() {
    let periods = pendulum::hanging_modes(G, 1.0).map(|rate| 2.0 * PI / rate);
    for (period, expected) in periods.into_iter().zip([1.668368, 0.726825, 0.463631]) {
        assert_near(period, expected, SIXTH_DECIMAL);
    }
    let chains = [(8, [1.196874, 2.608867, 3.792693]), (32, [1.202065, 2.749679, 4.261317])];
    for (segments, expected) in chains {
        for (rate, expected) in pendulum::chain_modes(segments, 0.5).into_iter().zip(expected) {
            assert_near(rate, expected, SIXTH_DECIMAL);
        }
    }
    assert_near(pendulum::stiff_period(G, 1.0, None), 1.637947, SIXTH_DECIMAL);
    assert_near(pendulum::stiff_period(G, 1.0, Some(8)), 1.644332, SIXTH_DECIMAL);
    for (degrees, factor) in [(30.0_f64, 1.017409), (60.0, 1.073182), (90.0, 1.180341)] {
        assert_near(pendulum::amplitude_factor(degrees.to_radians()), factor, SIXTH_DECIMAL);
    }
}

#[test]
fn falls_through_air() {
    let fall = BroadsideFall { gravity: G, density: 0.1, drag: 1.2 * 1.225 };
    assert_near(fall.terminal_speed(), 1.155290, SIXTH_DECIMAL);
    assert_near(fall.speed(0.1), 0.797865, SIXTH_DECIMAL);
    assert_near(fall.depth(0.5), 0.483367, SIXTH_DECIMAL);
    assert_near(fall.depth(1.0), 1.060984, SIXTH_DECIMAL);
    assert_near(fall.reversing_step(20.0), 6.8e-3, 0.05e-3);
    assert!(fall.dragged(20.0, 1.0) > 0.0);
    assert_near(
        fall.dragged(fall.dragged(-20.0, 0.3), 0.7),
        fall.dragged(-20.0, 1.0),
        SIXTH_DECIMAL,
    );
}

#[test]
fn falls_equal_the_sums_of_the_integrators() {
    let h = 1.0 / 180.0;
    let (mut x, mut v) = (0.0, 0.0);
    for n in 1..=50 {
        v -= G * h;
        x += v * h;
        assert_near(free_fall::symplectic_euler(G, h, n), x, 1e-12);
    }
    // The first step is backward Euler, the second BDF2; then, by the formula's definition in values: (5/3)
    // yₙ − (5/2) yₙ₋₁ + yₙ₋₂ − ⅙ yₙ₋₃ = h ẏₙ.
    let mut falls = [0.0, -G * h * h, -G * h * h * 8.0 / 3.0];
    assert_near(free_fall::bdf2_opt(G, h, 1), falls[1], 1e-12);
    assert_near(free_fall::bdf2_opt(G, h, 2), falls[2], 1e-12);
    for n in 3..=50 {
        let [y3, y2, y1] = falls;
        let v = -G * h * f64::from(n);
        let y = (h * v + 2.5 * y1 - y2 + y3 / 6.0) * 0.6;
        falls = [y2, y1, y];
        assert_near(free_fall::bdf2_opt(G, h, n), y, 1e-12);
    }
}

#[test]
fn dumbbells_lose_their_spin() {
    // The dumbbell turns at 20 rad/s with 180 steps a second, for one revolution.
    for (formula, lost) in [
        (BdfFormula::BACKWARD_EULER, 0.35),
        (BdfFormula::BDF2, 0.0184),
        (BdfFormula::BDF2_OPT, 0.0127),
    ] {
        assert_near(1.0 - spin_left(formula, 20.0, 1.0 / 180.0, 57), lost, 0.02 * lost + 0.0005);
    }
}

#[test]
fn strips_stretch() {
    assert_near(stretch::hung_strip(0.2, G, 1.0, 1e4), 9.81e-5, 1e-12);
    assert_near(stretch::full_tip_mass_factor(8), 1.125, 1e-12);
    assert_near(stretch::spinning_strip(0.2, 20.0, 1.0, 1e4), 80.0 / 3e4, 1e-12);
    assert_near(stretch::free_spinning_strip(0.2, 20.0, 1.0, 1e4), 80.0 / 12e4, 1e-12);
}

#[test]
fn case_passes_within_its_tolerance() {
    assert!(Case::new("near", 2.0, 2.01, 0.01).pass);
    assert!(!Case::new("far", 2.0, 1.97, 0.01).pass);
    assert!(!Case::new("lost", 2.0, f64::NAN, 0.01).pass);
}

/// Value at s = 1 of the solution of y'' + c sᵖ y = 0, y(0) = 1, y'(0) = 0, by its power series.
fn tilt_at_clamp(c: f64, power: i32) -> f64 {
    let (mut sum, mut term) = (1.0, 1.0);
    for k in 1..40 {
        let degree = f64::from(k * (power + 2));
        term *= -c / (degree * (degree - 1.0));
        sum += term;
    }
    sum
}

#[test]
fn strips_buckle() {
    // Measured from the free end: θ'' + w s θ = 0 for the column, β'' + (q s²/2)²/(EI·C) β = 0 for the strip.
    assert_near(tilt_at_clamp(SELF_WEIGHT_COLUMN, 1), 0.0, SIXTH_DECIMAL);
    assert_near(tilt_at_clamp((0.5 * LATERAL_BUCKLING).powi(2), 4), 0.0, SIXTH_DECIMAL);
    // A rigid link on one spring 2B/l carries half a link's mass: w l² (l/2) = 2B/l · l/l.
    assert_near(column_of_links(&[[0.25, 0.25]]), 4.0, SIXTH_DECIMAL);
    let mut masses = vec![[0.5, 0.5]; 64];
    masses[63] = [0.25, 0.25];
    assert_near(column_of_links(&masses), SELF_WEIGHT_COLUMN, 0.001);
}
