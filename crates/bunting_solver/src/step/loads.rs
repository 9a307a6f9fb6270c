//! The effort that a cloth needs: its substeps, from the loads that act on it now.
//!
//! A link of length l at the pins of a cloth of length L under an acceleration a vibrates at ω² = 4 a L/l², which
//! substeps must resolve: N = T √(L/l² · a/¾) in a tick of T seconds ([`StepLimits::of_fabric`]). Weight is one such
//! acceleration. The others that a cloth meets are turned into accelerations here, so that one formula holds for all, at
//! every size and level of detail:
//!
//! - *Air and frame*: (½ρ C_t u²/σ + |a| + (Ω² + |dΩ/dt|) L)/3, with u the wind relative to the frame, a the
//!   acceleration of the frame's origin and Ω its angular velocity. Along a streaming cloth tension is that of skin
//!   friction. One third, since vibration is seen on cloth that hangs still only.
//! - *Tension*: T/(σ L), with the tension T = Y ε by pins that are too far apart, as they strain a cloth in every state: ε in the mean of its
//!   particles.
//! - *Motion*: ¾ ω² l, with ω the rate at which links turn (root mean square). Directions of links are frozen in a
//!   pass, and what a turn leaves unsolved is carried along the L/l links of a chain: N = T ω √(L/l).
//! - *Contacts*: what chains pull into a collider in a substep h, contacts push out again, and links there are strained
//!   by (β h)² p/l, with p the acceleration by which contacts press steadily where they press most (the mean over contacts,
//!   weighted by squares). The acceleration κ p l/L, with κ = ¾ β²/ε, keeps that strain below ε.
//! - *Approach*: a collider near cloth that is held moves at a speed v relative to its frame. What it hits must not be moved farther in a substep
//!   than lines can pull the neighbours along, a part c of a link: N = T v/(c l), as by the acceleration ¾ v²/(c² L). It counts as one of
//!   contacts, from the tick before a collision on.
//! - *Flung cloth* moves fast on a wide path, v ω > 22 m/s² and v/ω > 0.2 L, and cracks like a whip where it turns back.
//!   It takes 300 substeps a second, as an acceleration ¾ (300/s)² l²/L; fewer where that is more than 640 m/s², as of
//!   links longer than 10 cm in cloth of a metre.
//!
//! Cloth without pins has no length L, and counts as a few links long (`FREE_LENGTH` in `constants.rs`).
//!
//! [`StepLimits::of_fabric`]: crate::StepLimits::of_fabric

use glam::Vec3;

use super::effort_class::{EffortCause, EffortClass};
use crate::constants::{BETA, FREE_LENGTH};
use crate::fabric::{Fabric, FabricMaterial};
use crate::stability::pin_strain::PinStrain;
use crate::step::Drive;
use crate::step::frame::FrameMotion;

/// Part of the accelerations by air and frame that counts. Smaller: light flags in 25 m/s have a 99.9 % strain of 4 %.
/// Larger: flags in 10 m/s take more substeps without need.
const PART_OF_AIR_AND_FRAME: f32 = 1.0 / 3.0;

/// Acceleration of a link that turns, over ω² l.
const OF_TURN: f32 = 0.75;

/// Greatest strain ε of links by contacts, where a shape presses most. Smaller: a sheet of 33 × 33 that rests on a ball or a
/// box takes half as many substeps again without need. Larger: sheets are drawn out by small shapes that they are pulled over.
const GREATEST_CONTACT_STRAIN: f32 = 0.2;

/// The factor κ = ¾ β²/ε of contacts.
const OF_CONTACTS: f32 = 0.75 * BETA * BETA / GREATEST_CONTACT_STRAIN;

/// Greatest way c of a collider near cloth in a substep, in lengths of a link. Smaller: cloth that slow shapes push aside takes more substeps
/// without need. Larger: a ball of 10 m/s draws a curtain out by 70 % and more.
const GREATEST_APPROACH: f32 = 0.15;

/// Acceleration of an approach, over (v/c)²/L.
const OF_APPROACH: f32 = 0.75;

/// Speed times turn rate of links (root mean squares) above which cloth may be flung, m/s². Smaller: sheets that swing
/// without a whip take more substeps. Larger: whips gain energy before they have more.
const FLUNG: f32 = 22.0;

/// Speed over turn rate, in units of the cloth's reach, above which cloth is flung and does not flutter. Smaller: flags
/// that fall or fly in wind count as flung. Larger: whips do not.
const FLUNG_RADIUS: f32 = 0.2;

/// Substeps in a second of cloth that is flung, 1/s. Fewer: whips gain energy. More: the change itself does.
const FLUNG_RATE: f32 = 300.0;

/// Greatest stiffness by which a strain counts as tension, N/m. Larger: pins that are apart by rounding are tension.
const STIFFEST: f32 = 1e6;

/// The highest class that air, frame and motion lead to. Lower: whips gain energy. Higher: flung flags whose links
/// are longer than 10 cm take more substeps.
const HIGHEST_OF_MOTION: u8 = 6;

/// Accelerations that act on a cloth besides gravity, as far as its substeps follow from them, m/s².
///
/// ```
/// use bunting_solver::Loads;
///
/// // An explosion: 800 m/s² by the air alone.
/// let (class, cause) = Loads { air: 800.0, ..Loads::default() }.class();
/// assert!(class > Loads::default().class().0, "{cause:?}");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Loads {
    /// Skin friction of the air, see [`of_air`](Self::of_air).
    pub air: f32,
    /// Acceleration of the frame, see [`of_frame`](Self::of_frame).
    pub frame: f32,
    /// Turn of the links, see [`of_motion`](Self::of_motion).
    pub motion: f32,
    /// Tension by pins, see [`of_pins`](Self::of_pins).
    pub tension: f32,
    /// Pressure of colliders, see [`ClothBatch::contact_load`](crate::ClothBatch::contact_load).
    pub contacts: f32,
}

impl Loads {
    /// Acceleration of a cloth along the wind by skin friction, ½ρ C_t u²/σ, m/s², with u relative to the frame in a
    /// tick of `tick` seconds, where a fabric is lightest.
    #[must_use]
    pub fn of_air(fabric: &Fabric, drive: &Drive, material: &FabricMaterial, tick: f32) -> f32 {
        let wind = drive.wind - drive.motion.translation / tick;
        let friction = drive.air_density * material.friction_coefficient;
        let lightest = material.area_density * fabric.extremes().lightest;
        0.5 * friction * wind.length_squared() / lightest
    }

    /// Acceleration of the frame between two ticks of `tick` seconds, at the farthest particle of a fabric, m/s².
    #[must_use]
    pub fn of_frame(before: &FrameMotion, now: &FrameMotion, fabric: &Fabric, tick: f32) -> f32 {
        if before.is_none() && now.is_none() {
            return 0.0;
        }
        let velocity = before.rotation.inverse() * before.translation;
        let acceleration = (now.translation - velocity).length() / (tick * tick);
        let [earlier, rate] = [before, now].map(|motion| motion.turn() / tick);
        let turn = rate.length_squared() + (rate - earlier).length() / tick;
        acceleration + turn * fabric.reach()
    }

    /// Acceleration ¾ ω² l of links of length l that turn at a rate ω (root mean square), or that of flung cloth, m/s²,
    /// from the positions of a fabric's particles before and after a tick of `tick` seconds.
    #[must_use]
    pub fn of_motion(fabric: &Fabric, before: &[Vec3], after: &[Vec3], tick: f32) -> f32 {
        if before.len() != after.len() {
            return 0.0;
        }
        let (mut turns, mut displacements) = (0.0, 0.0);
        for probe in fabric.probes() {
            let [from, to] = probe
                .particles
                .map(|particle| after[particle as usize] - before[particle as usize]);
            turns += (to - from).length_squared() * probe.inverse_length_squared;
            displacements += from.length_squared();
        }
        Self::of_probes(fabric, turns, displacements, tick)
    }

    /// The acceleration T/(σ L) of a fabric's cloth of length L with the tension T by pins that are farther apart than the cloth between
    /// them is long, at positions of its particles, m/s². The paths between such pins are searched.
    #[must_use]
    pub fn of_pins(fabric: &Fabric, material: &FabricMaterial, positions: &[Vec3]) -> f32 {
        if positions.len() != fabric.particle_count() {
            return 0.0;
        }
        Self::of_pin_strain(fabric, material, &PinStrain::of(fabric, positions))
    }

    /// The same, given the strain by pins.
    pub(crate) fn of_pin_strain(
        fabric: &Fabric,
        material: &FabricMaterial,
        strain: &PinStrain,
    ) -> f32 {
        let mean = strain.mean();
        if mean <= 0.0 || fabric.reach() <= 0.0 {
            return 0.0;
        }
        let extremes = fabric.extremes();
        let stiffest = extremes.stiffest_stretch(material).min(STIFFEST);
        stiffest * mean / (material.area_density * extremes.lightest * fabric.reach())
    }

    /// The load κ p l/L of colliders that press the cloth with an acceleration p, m/s².
    #[must_use]
    pub(crate) fn of_contacts(fabric: &Fabric, pressing: f32) -> f32 {
        let link = fabric.shortest_link();
        OF_CONTACTS * pressing * link / fabric.reach().max(FREE_LENGTH * link)
    }

    /// The load ¾ v²/(c² L) of colliders that move at a speed v relative to the frame, m/s.
    #[must_use]
    pub(crate) fn of_approach(fabric: &Fabric, speed: f32) -> f32 {
        let reach = fabric.reach().max(FREE_LENGTH * fabric.shortest_link());
        OF_APPROACH * (speed / GREATEST_APPROACH).powi(2) / reach
    }

    /// The same from sums over the probes of a fabric: of the squared angles by which they turn in the tick, rad², and of
    /// the squared displacements of their first ends, m².
    pub(crate) fn of_probes(fabric: &Fabric, turns: f32, displacements: f32, tick: f32) -> f32 {
        let probes = fabric.probes().len();
        if probes == 0 || tick <= 0.0 {
            return 0.0;
        }
        let to_mean = 1.0 / (probes as f32 * tick * tick);
        let (squared_rate, squared_speed) = (turns * to_mean, displacements * to_mean);
        let link = fabric.shortest_link();
        let turning = OF_TURN * squared_rate * link;
        let is_wide = squared_speed > squared_rate * (FLUNG_RADIUS * fabric.reach()).powi(2);
        // Cloth without pins has no end that could crack.
        let has_end = fabric.reach() > 0.0;
        let is_flung = has_end && is_wide && squared_rate * squared_speed > FLUNG * FLUNG;
        let flung = OF_TURN * (FLUNG_RATE * link).powi(2) / fabric.reach();
        if is_flung { turning.max(flung) } else { turning }
    }

    /// The class of effort that these loads need, and the reason.
    #[must_use]
    pub fn class(&self) -> (EffortClass, EffortCause) {
        let steady = PART_OF_AIR_AND_FRAME * (self.air + self.frame);
        let of_steady = if self.air >= self.frame { EffortCause::Air } else { EffortCause::Frame };
        let needs = [
            (self.contacts, EffortClass::HIGHEST, EffortCause::Contacts),
            (self.tension, EffortClass::HIGHEST, EffortCause::Tension),
            (self.motion, HIGHEST_OF_MOTION, EffortCause::Motion),
            (steady, HIGHEST_OF_MOTION, of_steady),
        ];
        let mut greatest = (EffortClass::default(), 0.0, EffortCause::Weight);
        for (load, highest, cause) in needs {
            let class = EffortClass::of(load, highest);
            if class > EffortClass::default() && (class, load) > (greatest.0, greatest.1) {
                greatest = (class, load, cause);
            }
        }
        (greatest.0, greatest.2)
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::fabric::{FabricBuilder, Grid};
    use crate::step::limits::StepLimits;

    const TICK: f32 = 1.0 / 60.0;

    fn flag(n: u32) -> Fabric {
        let grid = FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0));
        grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric")
    }

    fn substeps(n: u32, loads: &Loads) -> u32 {
        let acceleration = loads.class().0.acceleration(9.81);
        StepLimits::default().of_fabric(&flag(n), TICK, acceleration).substeps
    }

    fn streaming(wind: f32, area_density: f32) -> Loads {
        let material = FabricMaterial { area_density, ..FabricMaterial::FLAG_POLYESTER };
        let drive = Drive { wind: Vec3::X * wind, ..Drive::default() };
        Loads { air: Loads::of_air(&flag(5), &drive, &material, TICK), ..Loads::default() }
    }

    #[test]
    fn light_cloth_in_strong_wind_needs_more_substeps() {
        let of_winds =
            |density: f32| [6.0, 10.0, 25.0].map(|wind| substeps(33, &streaming(wind, density)));
        assert_eq!(of_winds(1.5), [2, 2, 2]);
        assert_eq!(of_winds(0.113), [2, 2, 4]);
        assert_eq!(of_winds(0.03), [2, 3, 8]);
        assert_eq!([17, 65].map(|n| substeps(n, &streaming(25.0, 0.113))), [2, 8]);
    }

    #[test]
    fn wind_counts_relative_to_the_frame() {
        let motion = FrameMotion { translation: Vec3::X * 25.0 * TICK, ..FrameMotion::NONE };
        let drive = Drive { wind: Vec3::X * 25.0, motion, ..Drive::default() };
        assert!(Loads::of_air(&flag(5), &drive, &FabricMaterial::NYLON, TICK) < 1e-6);
    }

    #[test]
    fn frames_load_by_jerks_and_turns_but_not_by_steady_speed() {
        let fabric = flag(33);
        let moving =
            |speed: f32| FrameMotion { translation: Vec3::X * speed * TICK, ..FrameMotion::NONE };
        let turning = |rate: f32| FrameMotion {
            rotation: Quat::from_rotation_y(rate * TICK),
            ..FrameMotion::NONE
        };
        let load = |before, now| Loads::of_frame(&before, &now, &fabric, TICK);
        assert!(load(moving(20.0), moving(20.0)) < 0.01);
        assert!((load(moving(20.0), FrameMotion::NONE) / 1200.0 - 1.0).abs() < 1e-3);
        let centripetal = 400.0 * fabric.reach();
        assert!((load(turning(20.0), turning(20.0)) / centripetal - 1.0).abs() < 1e-3);
        // On a circle the origin's velocity stays the same along the frame's axes, and turns in the world.
        let round = FrameMotion { translation: moving(2.0).translation, ..turning(3.0) };
        let expected = 6.0 + 9.0 * fabric.reach();
        assert!((load(round, round) / expected - 1.0).abs() < 0.01, "{}", load(round, round));
    }

    #[test]
    fn links_that_turn_load_the_cloth_and_shifted_links_do_not() {
        let fabric = flag(33);
        let before = fabric.rest_positions();
        let load = |turn: f32, shift: f32| {
            let turn = Quat::from_rotation_y(turn * TICK);
            let after: Vec<Vec3> = before.iter().map(|at| turn * *at + Vec3::Z * shift).collect();
            // Warp turns about the weft, which does not turn: half of all links.
            Loads::of_motion(&fabric, before, &after, TICK)
        };
        assert!(load(0.0, 1.0) < 1e-3);
        let expected = 0.75 * 0.5 * 25.0 / 32.0;
        assert!((load(5.0, 0.0) / expected - 1.0).abs() < 0.1, "{}", load(5.0, 0.0));
    }

    #[test]
    fn cloth_is_flung_where_it_is_fast_and_turns() {
        let substeps_of = |n: u32, speed: f32, turn: f32| {
            let fabric = flag(n);
            let before = fabric.rest_positions();
            // A wave along the warp, whose links are half of all.
            let wave = |at: &Vec3| 2.0 * turn / 12.0 * libm::sinf(12.0 * at.x);
            let moved = |at: &Vec3| *at + Vec3::Z * (speed + wave(at)) * TICK;
            let after: Vec<Vec3> = before.iter().map(moved).collect();
            let motion = Loads::of_motion(&fabric, before, &after, TICK);
            substeps(n, &Loads { motion, ..Loads::default() })
        };
        for (n, calm) in [(17, 2), (33, 2), (65, 4)] {
            assert_eq!(substeps_of(n, 2.5, 5.0), calm, "slow turn");
            assert_eq!(substeps_of(n, 0.0, 17.0), calm, "flutter");
            assert_eq!(substeps_of(n, 2.7, 10.0), 6, "whip");
        }
    }

    #[test]
    fn only_contacts_and_tension_lead_to_the_highest_classes() {
        let class = |loads: Loads| loads.class().0.index();
        assert_eq!(class(Loads { contacts: 1e4, ..Loads::default() }), EffortClass::COUNT - 1);
        assert_eq!(class(Loads { tension: 1e4, ..Loads::default() }), EffortClass::COUNT - 1);
        let others = Loads { air: 1e5, frame: 1e5, motion: 1e5, contacts: 0.0, tension: 0.0 };
        assert_eq!(class(others), usize::from(HIGHEST_OF_MOTION));
        assert_eq!(Loads { contacts: 1e4, ..others }.class().1, EffortCause::Contacts);
    }

    #[test]
    fn cloth_that_its_pins_draw_out_is_tense_and_other_cloth_is_not() {
        let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
        let fabric = grid.pin_where(|_, uv| uv.x == 0.0 || uv.x == 1.0).build().expect("good");
        let material = FabricMaterial {
            warp_stiffness: 2e3,
            weft_stiffness: 500.0,
            area_density: 0.1,
            ..FabricMaterial::FLAG_POLYESTER
        };
        let load = |stretch: Vec3| {
            let to = |at: &Vec3| *at * stretch;
            let drawn: Vec<Vec3> = fabric.rest_positions().iter().map(to).collect();
            Loads::of_pins(&fabric, &material, &drawn)
        };
        let tension = load(Vec3::new(1.02, 1.0, 1.0));
        let expected = 2e3 * 0.02 / (0.1 * fabric.reach());
        assert!((tension / expected - 1.0).abs() < 0.01, "{tension} {expected}");
        assert_eq!([load(Vec3::ONE), load(Vec3::splat(0.9))], [0.0; 2]);
        assert_eq!(Loads { tension, ..Loads::default() }.class().1, EffortCause::Tension);
    }
}
