//! Checks the values of a scene whose keys and types are valid.

use bevy_math::Vec3;
use bunting_solver::{FabricError, FabricMaterial};

use crate::key::Key;
use crate::material::{MaterialRecipe, PRESETS};
use crate::scene::{Flag, Footing, Levels, Route, Scene, Vehicle, Wind};

/// A value that cannot be used, and the reason.
#[derive(Debug)]
pub(crate) struct BadValue {
    pub key: Key,
    pub reason: String,
}

type Check = Result<(), BadValue>;

pub(crate) fn scene(scene: &Scene) -> Check {
    for (index, one) in scene.winds.iter().enumerate() {
        wind(one, &Key::top("winds").index(index))?;
    }
    let viewer = Key::top("viewer");
    route(&scene.viewer.track, &viewer.name("track"))?;
    finite(scene.viewer.looks_at, &viewer.name("looks_at"))?;
    levels(&scene.levels, &Key::top("levels"))?;
    for (name, recipe) in &scene.materials {
        material(recipe, &Key::top("materials").name(name))?;
    }
    for (name, one) in &scene.vehicles {
        vehicle(one, &Key::top("vehicles").name(name))?;
    }
    require(!scene.flags.is_empty(), &Key::top("flags"), || {
        "a scene needs at least one flag".to_owned()
    })?;
    for (index, one) in scene.flags.iter().enumerate() {
        flag(one, scene, &Key::top("flags").index(index))?;
    }
    Ok(())
}

fn wind(wind: &Wind, key: &Key) -> Check {
    finite(wind.velocity, &key.name("velocity"))?;
    not_negative(wind.gust_strength, &key.name("gust_strength"))?;
    not_negative(wind.gust_frequency, &key.name("gust_frequency"))
}

fn route(route: &Route, key: &Key) -> Check {
    let waypoints = key.name("waypoints");
    let count = route.waypoints.len();
    require(count >= 3, &waypoints, || {
        format!("a closed path needs at least 3 waypoints, not {count}")
    })?;
    for (index, &waypoint) in route.waypoints.iter().enumerate() {
        let key = waypoints.index(index);
        finite(waypoint, &key)?;
        let before = route.waypoints[(index + count - 1) % count];
        require(waypoint != before, &key, || "the same as the waypoint before".to_owned())?;
    }
    let speed = route.speed;
    require((0.0..=Route::MAX_SPEED).contains(&speed), &key.name("speed"), || {
        format!("{speed} is not a speed from 0 to {} m/s", Route::MAX_SPEED)
    })?;
    not_negative(route.start, &key.name("start"))
}

fn levels(levels: &Levels, key: &Key) -> Check {
    let (finest, distances) = (levels.finest, &levels.switch_distances);
    let halvings = finest.saturating_sub(1).trailing_zeros() as usize;
    require(finest >= 3 && halvings > 0, &key.name("finest"), || {
        format!("{finest} particles along an edge cannot be halved: use 2ⁿ + 1")
    })?;
    let key = key.name("switch_distances");
    require(distances.len() <= halvings, &key, || {
        format!("{finest} particles along an edge halve {halvings} times, not {}", distances.len())
    })?;
    for (index, &distance) in distances.iter().enumerate() {
        let before = index.checked_sub(1).map_or(0.0, |before| distances[before]);
        require(distance > before && distance.is_finite(), &key.index(index), || {
            format!("{distance} m is not farther than {before} m")
        })?;
    }
    Ok(())
}

fn material(recipe: &MaterialRecipe, key: &Key) -> Check {
    let material = recipe.material().ok_or_else(|| BadValue {
        key: key.name("like"),
        reason: format!("no preset is called \"{}\": there are {}", recipe.like, preset_names()),
    })?;
    match FabricMaterial::validate(&material) {
        Ok(()) => Ok(()),
        Err(FabricError::Material { name, value }) => {
            Err(BadValue { key: key.name(name), reason: format!("{value} cannot be simulated") })
        }
        Err(error) => Err(BadValue { key: key.clone(), reason: error.to_string() }),
    }
}

fn vehicle(vehicle: &Vehicle, key: &Key) -> Check {
    require(!vehicle.model.is_empty(), &key.name("model"), || "no file is named".to_owned())?;
    route(&vehicle.track, &key.name("track"))?;
    finite(vehicle.socket, &key.name("socket"))
}

fn flag(flag: &Flag, scene: &Scene, key: &Key) -> Check {
    match &flag.on {
        Footing::Ground { x, z } => finite(Vec3::new(*x, 0.0, *z), &key.name("on"))?,
        Footing::Vehicle(name) => {
            require(scene.vehicles.contains_key(name), &key.name("on"), || {
                format!("no vehicle is called \"{name}\"")
            })?;
        }
    }
    positive(flag.pole, &key.name("pole"))?;
    positive(flag.size.x, &key.name("size").index(0))?;
    positive(flag.size.y, &key.name("size").index(1))?;
    require(flag.size.y <= flag.pole, &key.name("size").index(1), || {
        format!("{} m hang below the foot of a pole of {} m", flag.size.y, flag.pole)
    })?;
    require(scene.material(&flag.material).is_some(), &key.name("material"), || {
        format!("no material is called \"{}\": presets are {}", flag.material, preset_names())
    })
}

fn preset_names() -> String {
    PRESETS.map(|(name, _)| format!("\"{name}\"")).join(", ")
}

fn positive(value: f32, key: &Key) -> Check {
    require(value > 0.0 && value.is_finite(), key, || format!("{value} is not positive"))
}

fn not_negative(value: f32, key: &Key) -> Check {
    require(value >= 0.0 && value.is_finite(), key, || format!("{value} is negative or not finite"))
}

fn finite(value: Vec3, key: &Key) -> Check {
    require(value.is_finite(), key, || format!("{value} is not finite"))
}

fn require(holds: bool, key: &Key, reason: impl FnOnce() -> String) -> Check {
    if holds { Ok(()) } else { Err(BadValue { key: key.clone(), reason: reason() }) }
}
