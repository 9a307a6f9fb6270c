//! Reactions of anchors: weight at rest, drag in wind, and the momentum of cloth that is swung.

use std::{f32::consts::FRAC_PI_2, time::Instant};

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::{entity::Entity, system::RunSystemOnce};
use bevy_transform::components::Transform;
use glam::{DVec3, Quat, Vec2, Vec3};

use crate::{
    contacts::Row,
    game,
    product::{DEFAULT, TICK},
};

/// Undamped polyester.
const MATERIAL: FabricMaterial =
    FabricMaterial { damping: 0.0, internal_damping: 0.0, ..FabricMaterial::FLAG_POLYESTER };

/// Damped, to come to rest.
const DAMPED: FabricMaterial = FabricMaterial { damping: 2.0, ..FabricMaterial::FLAG_POLYESTER };

/// Greatest errors, of one.
const AT_REST: f64 = 0.01;
const IN_WIND: f64 = 0.02;
const SWINGING: f64 = 0.01;

/// Ticks of swinging before the momentum is compared. In a whip, forces of single substeps differ from the means over them.
const SWING_TICKS: usize = 300;

/// Standard gravity, m/s².
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);

/// A steady wind, m/s.
const WIND: Vec3 = Vec3::new(3.0, 0.0, 4.0);

/// A sheet, and what holds it.
struct Hung {
    name: &'static str,
    mesh: ClothMesh,
    vertices: AttachedVertices,
    /// Vertices on a second target, and where that is, m.
    other: Option<(AttachedVertices, Vec3)>,
}

fn sheets() -> Vec<Hung> {
    let sheet = |n: u32| ClothMesh::grid(n, n, 1.0, 1.0);
    let hung = |name, mesh, vertices| Hung { name, mesh, vertices, other: None };
    let corners = || AttachedVertices::Corners(vec![ClothCorner::TopLeft, ClothCorner::TopRight]);
    let band = |name, at: Vec3| Hung {
        other: Some((ClothEdge::Right.into(), at)),
        ..hung(name, ClothMesh::grid(33, 9, 1.0, 0.2), ClothEdge::Left.into())
    };
    vec![
        hung("curtain", sheet(17), ClothEdge::Top.into()),
        hung("flag", sheet(17), ClothEdge::Left.into()),
        hung("flag of 33", sheet(33), ClothEdge::Left.into()),
        hung("sheet by two corners", sheet(17), corners()),
        hung("mesh", triangles(17), ClothEdge::Top.into()),
        band("band", Vec3::new(0.8, 0.0, 0.0)),
        band("band aslant", Vec3::new(0.6, 0.5, 0.0)),
    ]
}

/// A sheet of n × n vertices, whose triangles make it no grid.
fn triangles(n: u32) -> ClothMesh {
    let at = |index: u32| index as f32 / (n - 1) as f32;
    let corners = (0..n).flat_map(|row| (0..n).map(move |column| (column, row)));
    let uv: Vec<Vec2> = corners.clone().map(|(u, v)| Vec2::new(at(u), at(v))).collect();
    let positions = uv.iter().map(|uv| Vec3::new(uv.x, -uv.y, 0.0)).collect();
    let cells = corners.filter(|&(column, row)| column + 1 < n && row + 1 < n);
    let indices = cells.flat_map(|(column, row)| {
        let [a, b] = [row * n + column, row * n + column + 1];
        let [c, d] = [a + n, b + n];
        if (column + row) % 2 == 0 { [a, c, b, b, c, d] } else { [a, c, d, a, d, b] }
    });
    ClothMesh::triangles(positions, indices.collect(), uv)
}

impl Hung {
    /// Spawns the sheet, with the second target at its place if `reaches`. Returns the targets and the cloth.
    fn spawn(&self, app: &mut App, material: FabricMaterial) -> ([Entity; 2], Entity) {
        let mut target = |at: Vec3| app.world_mut().spawn(Transform::from_translation(at)).id();
        let place = self.other.as_ref().map_or(Vec3::ZERO, |(_, at)| *at);
        let targets = [target(Vec3::ZERO), target(place)];
        let mut attachment = Attachment::new(targets[0], self.vertices.clone());
        if let Some((vertices, _)) = &self.other {
            let offset = Transform::from_xyz(-1.0, 0.0, 0.0);
            attachment = attachment
                .with_anchor(Anchor::new(targets[1], vertices.clone()).with_offset(offset));
        }
        let parts =
            (self.mesh.clone(), ClothMaterial(material), attachment, AnchorReactions::default());
        (targets, app.world_mut().spawn(parts).id())
    }
}

fn force(app: &App, cloth: Entity) -> DVec3 {
    let reactions = app.world().get::<AnchorReactions>(cloth).expect("reactions");
    let all = reactions.anchors.iter().chain([&reactions.target]);
    all.map(|reaction| reaction.force.as_dvec3()).sum()
}

/// Sums over the particles of a cloth along the world's axes.
#[derive(Clone, Copy)]
struct Sums {
    mass: f64,
    momentum: DVec3,
    /// Force of the air, N.
    air: DVec3,
}

fn sums(app: &mut App, cloth: Entity, material: FabricMaterial, wind: Vec3) -> Sums {
    let sum = move |mut control: ClothControl| {
        control.edit(cloth, |cloth| {
            let rotation = cloth.frame().rotation.as_dquat();
            let count = cloth.count();
            let velocities =
                (0..count).map(|at| cloth.velocity(at)).collect::<Result<Vec<_>, _>>()?;
            let positions =
                (0..count).map(|at| cloth.position(at)).collect::<Result<Vec<_>, _>>()?;
            let masses = cloth.fabric().particle_areas().iter();
            let masses: Vec<f64> =
                masses.map(|&area| f64::from(area * material.area_density)).collect();
            let pairs = velocities.iter().zip(&masses);
            let momentum: DVec3 = pairs.map(|(v, &mass)| v.as_dvec3() * mass).sum();
            let wind = rotation.inverse() * wind.as_dvec3();
            let mut air = DVec3::ZERO;
            for corners in cloth.fabric().triangles() {
                let [a, b, c] = corners.map(|at| positions[at as usize].as_dvec3());
                let moving: DVec3 =
                    corners.map(|at| velocities[at as usize].as_dvec3()).into_iter().sum();
                let normal = (b - a).cross(c - a);
                let (area, normal) = (0.5 * normal.length(), normal.normalize_or_zero());
                let u = wind - moving / 3.0;
                let across = u.dot(normal);
                let density = 0.5 * 1.225 * area;
                let [pressure, friction] =
                    [material.pressure_coefficient, material.friction_coefficient].map(f64::from);
                air += normal * (density * pressure * across.abs() * across)
                    + (u - normal * across) * (density * friction * u.length());
            }
            Ok(Sums {
                mass: masses.iter().sum(),
                momentum: rotation * momentum,
                air: rotation * air,
            })
        })
    };
    let sums = app.world_mut().run_system_once(sum).expect("the system runs");
    sums.expect("the cloth is simulated")
}

/// Error of the forces of a sheet at rest: of their sum as a part of the weight.
fn at_rest(hung: &Hung, seconds: f32) -> Row {
    let mut app = game::app_in_still_air([DEFAULT]);
    let (_, cloth) = hung.spawn(&mut app, DAMPED);
    let ticks = (seconds / TICK) as usize;
    let start = Instant::now();
    (0..ticks).for_each(|_| app.update());
    let us = 1e6 * start.elapsed().as_secs_f64() / ticks as f64;
    let weight = sums(&mut app, cloth, DAMPED, Vec3::ZERO).mass * GRAVITY;
    let error = force(&app, cloth).distance(weight) / weight.length();
    let name = format!("reactions, {} at rest", hung.name);
    Row::new(name, "error of the weight, of one", error, AT_REST, us)
}

/// Error of the mean force of a sheet in steady wind, as a part of the mean of drag and weight.
fn in_wind(hung: &Hung, seconds: f32) -> Row {
    let mut app = game::app_in_still_air([DEFAULT]);
    app.world_mut().spawn(WindField::steady(WIND));
    let (_, cloth) = hung.spawn(&mut app, MATERIAL);
    let ticks = (seconds / TICK) as usize;
    let start = Instant::now();
    (0..ticks).for_each(|_| app.update());
    let (mut felt, mut expected) = (DVec3::ZERO, DVec3::ZERO);
    for _ in 0..ticks {
        app.update();
        let sums = sums(&mut app, cloth, MATERIAL, WIND);
        felt += force(&app, cloth);
        expected += sums.air + sums.mass * GRAVITY;
    }
    let us = 1e6 * start.elapsed().as_secs_f64() / (2 * ticks) as f64;
    let error = felt.distance(expected) / expected.length();
    let name = format!("reactions, {} in wind", hung.name);
    Row::new(name, "error of drag and weight, of one", error, IN_WIND, us)
}

/// Error of the momentum that a sheet has after a swing: as a part of the impulse of its anchors so far.
fn swinging(hung: &Hung, ticks: usize) -> Row {
    let mut app = game::app_in_still_air([DEFAULT]);
    app.world_mut().resource_mut::<ClothSettings>().air_density = 0.0;
    let (targets, cloth) = hung.spawn(&mut app, MATERIAL);
    let places =
        targets.map(|target| app.world().get::<Transform>(target).expect("a target").translation);
    let start = Instant::now();
    let (mut impulse, mut absolute, mut worst) = (DVec3::ZERO, 0.0, 0.0_f64);
    let mut first = None;
    for tick in 0..ticks {
        let time = tick as f32 * TICK;
        let turn = Quat::from_rotation_y(0.5 * libm::sinf(2.0 * time));
        let way = Vec3::new(0.3 * libm::sinf(3.0 * time), 0.1 * libm::sinf(5.0 * time), 0.0);
        for (target, place) in targets.into_iter().zip(places) {
            *app.world_mut().get_mut::<Transform>(target).expect("a target") =
                Transform::from_translation(way + turn * place).with_rotation(turn);
        }
        app.update();
        if tick < 30 {
            continue;
        }
        let sums = sums(&mut app, cloth, MATERIAL, Vec3::ZERO);
        // In the first ticks the cloth is new.
        let Some(first) = first else {
            first = Some(sums.momentum);
            continue;
        };
        let given = (sums.mass * GRAVITY - force(&app, cloth)) * f64::from(TICK);
        impulse += given;
        absolute += force(&app, cloth).length() * f64::from(TICK);
        let error = (sums.momentum - first).distance(impulse);
        if tick > 30 + SWING_TICKS {
            worst = worst.max(error / absolute);
        }
    }
    let us = 1e6 * start.elapsed().as_secs_f64() / ticks as f64;
    let name = format!("reactions, {} swinging", hung.name);
    Row::new(name, "error of the momentum, of the impulse", worst, SWINGING, us)
}

/// Error of the force on the second mast of a limp band on its side, as a part of the closed form: each end pulls along
/// its last links, the horizontal parts are opposite, and the vertical parts are the weight.
fn division(name: &str, place: Vec3, seconds: f32) -> Row {
    const COLUMNS: usize = 33;
    let mut app = game::app_in_still_air([DEFAULT]);
    let on_side = Quat::from_rotation_x(-FRAC_PI_2);
    let target = |at: Vec3| Transform::from_translation(at).with_rotation(on_side);
    let targets = [Vec3::ZERO, place].map(|at| app.world_mut().spawn(target(at)).id());
    let held =
        Anchor::new(targets[1], ClothEdge::Right).with_offset(Transform::from_xyz(-1.0, 0.0, 0.0));
    let attachment = Attachment::new(targets[0], ClothEdge::Left).with_anchor(held);
    let band = (ClothMesh::grid(COLUMNS as u32, 5, 1.0, 0.1), ClothMaterial(DAMPED), attachment);
    let band = app.world_mut().spawn((band, AnchorReactions::default())).id();
    let ticks = (seconds / TICK) as usize;
    let start = Instant::now();
    (0..ticks).for_each(|_| app.update());
    let us = 1e6 * start.elapsed().as_secs_f64() / ticks as f64;
    let weight = sums(&mut app, band, DAMPED, Vec3::ZERO).mass * GRAVITY.y;
    let state = app.world().get::<ClothState>(band).expect("a cloth");
    let rows = state.positions().chunks(COLUMNS);
    let slope = |of: &dyn Fn(&[Vec3]) -> Vec3| {
        let along: Vec3 = rows.clone().map(of).sum();
        let along = on_side * along;
        f64::from(along.y / along.x)
    };
    let slopes = [slope(&|row| row[1] - row[0]), slope(&|row| row[COLUMNS - 1] - row[COLUMNS - 2])];
    // The held vertices carry half of a column each.
    let of_pins = weight / (2 * (COLUMNS - 1)) as f64;
    let level = (weight - 2.0 * of_pins) / (slopes[0] - slopes[1]);
    let expected = DVec3::new(-level, of_pins - level * slopes[1], 0.0);
    let reactions = app.world().get::<AnchorReactions>(band).expect("reactions");
    let error = reactions.anchors[0].force.as_dvec3().distance(expected) / expected.length();
    Row::new(
        format!("reactions, {name}"),
        "error of one anchor's force, of one",
        error,
        AT_REST,
        us,
    )
}

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let seconds = if quick { 8.0 } else { 20.0 };
    let mut rows = vec![
        division("mast of a level band", Vec3::new(0.8, 0.0, 0.0), seconds),
        division("mast of a band aslant", Vec3::new(0.6, 0.5, 0.0), seconds),
    ];
    for hung in sheets() {
        rows.push(at_rest(&hung, seconds));
        // A level band vibrates in wind: its integrator restarts in each substep, and its air is that of backward Euler,
        // 9 % too little with two substeps, 3 % with eight.
        if hung.name != "band" {
            rows.push(in_wind(&hung, if quick { 4.0 } else { 10.0 }));
        }
        rows.push(swinging(&hung, if quick { 400 } else { 900 }));
    }
    rows
}
