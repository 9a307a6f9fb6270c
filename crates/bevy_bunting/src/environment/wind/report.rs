//! Reports winds that cannot blow as they are written.

use bevy_ecs::prelude::*;

use crate::cloth::error::ClothError;
use crate::cloth::error::NumberRule::{self, Finite, NotNegative, Positive};
use crate::cloth::events::ClothFailed;
use crate::environment::wind::blast::WindBlast;
use crate::environment::wind::fan::WindFan;
use crate::environment::wind::field::WindField;
use crate::environment::wind::region::{WindRegion, WindShape};
use crate::environment::wind::wake::WindWake;

/// A number of a wind: the name of its field, its value, and what it must be.
type Number = (&'static str, f32, NumberRule);

/// Reports the first number of a wind that cannot be.
fn report(commands: &mut Commands, entity: Entity, component: &'static str, numbers: &[Number]) {
    if let Some(&(name, value, rule)) = numbers.iter().find(|(_, value, rule)| !rule.allows(*value))
    {
        let error = ClothError::Wind { entity, component, name, value, rule };
        ClothFailed::report(commands, entity, error);
    }
}

/// Reports numbers of winds that cannot be, whenever they change. A blast, which each tick changes, is checked when it is new.
pub(super) fn report_winds(
    fields: Query<(Entity, &WindField), Changed<WindField>>,
    fans: Query<(Entity, &WindFan), Changed<WindFan>>,
    blasts: Query<(Entity, &WindBlast), Added<WindBlast>>,
    wakes: Query<(Entity, &WindWake), Changed<WindWake>>,
    mut commands: Commands,
) {
    for (entity, field) in &fields {
        let numbers = [
            ("velocity", field.velocity.x, Finite),
            ("velocity", field.velocity.y, Finite),
            ("velocity", field.velocity.z, Finite),
            ("gust_strength", field.gust_strength, Finite),
            ("gust_frequency", field.gust_frequency, Finite),
        ];
        report(&mut commands, entity, "WindField", &numbers);
    }
    for (entity, fan) in &fans {
        let numbers = [
            ("speed", fan.speed, Finite),
            ("radius", fan.radius, NotNegative),
            ("reach", fan.reach, NotNegative),
        ];
        report(&mut commands, entity, "WindFan", &numbers);
    }
    for (entity, blast) in &blasts {
        let numbers = [
            ("speed", blast.speed, Finite),
            ("radius", blast.radius, NotNegative),
            ("front_speed", blast.front_speed, Positive),
            ("duration", blast.duration, Positive),
            ("age", blast.age, Finite),
        ];
        report(&mut commands, entity, "WindBlast", &numbers);
    }
    for (entity, wake) in &wakes {
        let numbers = [("drag_area", wake.drag_area, NotNegative)];
        report(&mut commands, entity, "WindWake", &numbers);
    }
}

/// Reports lengths of regions that cannot be, and regions that bound no wind, whenever they change.
pub(super) fn report_regions(
    regions: Query<(Entity, &WindRegion, Has<WindField>), Changed<WindRegion>>,
    mut commands: Commands,
) {
    for (entity, WindRegion { shape, falloff }, has_field) in &regions {
        let lengths = match *shape {
            WindShape::Box { half_extents } => {
                let [x, y, z] = half_extents.to_array();
                [("half_extents", x), ("half_extents", y), ("half_extents", z)]
            }
            WindShape::Sphere { radius } => [("radius", radius); 3],
            WindShape::Cone { length, radius } => {
                [("length", length), ("radius", radius), ("radius", radius)]
            }
            WindShape::Capsule { half_height, radius } => {
                [("half_height", half_height), ("radius", radius), ("radius", radius)]
            }
        };
        let lengths = lengths.map(|(name, length)| (name, length, NotNegative));
        let falloff = [("falloff", *falloff, Finite)];
        report(&mut commands, entity, "WindRegion", &[&lengths[..], &falloff].concat());
        if !has_field {
            ClothFailed::report(&mut commands, entity, ClothError::NoField { entity });
        }
    }
}
