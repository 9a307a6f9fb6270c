//! The figure of a glTF file, with its body, cape and colliders: Bevy's animation blends how it stands, walks and runs.

use std::f32::consts::TAU;

use bevy::app::AnimationSystems;
use bevy::gltf::Gltf;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::{Design, Model};

use crate::figure::cloak::CRIMSON;
use crate::figure::walker::Walker;

/// The file.
const FILE: &str = "cloths/caped_figure.gltf";

/// The animations that are blended, by their names in the file.
const GAITS: [&str; 3] = ["Stand", "Walk", "Run"];

/// Spawns the figure, and plays it once it is loaded.
pub fn plugin(app: &mut App) {
    app.world_mut().spawn((Walker::default(), Model(FILE.to_owned()), Transform::default()));
    app.add_systems(PostStartup, load)
        .add_systems(Update, show.run_if(resource_exists::<Figure>))
        .add_systems(PostUpdate, play.before(AnimationSystems).run_if(resource_exists::<Gaits>))
        .add_observer(begin)
        .add_observer(dye);
}

/// The figure's file.
#[derive(Resource)]
struct Figure(Handle<Gltf>);

/// The animations that are blended, in the order of [`GAITS`].
#[derive(Resource)]
struct Gaits {
    graph: Handle<AnimationGraph>,
    clips: [Handle<AnimationClip>; 3],
    nodes: Vec<AnimationNodeIndex>,
}

fn load(mut commands: Commands, assets: Res<AssetServer>) {
    commands.insert_resource(Figure(assets.load(FILE)));
}

/// Shows the figure when its whole file is loaded: with its animations, so that it is never seen in its bind pose.
fn show(
    walker: Single<Entity, (With<Walker>, Without<WorldAssetRoot>)>,
    figure: Res<Figure>,
    files: Res<Assets<Gltf>>,
    mut commands: Commands,
    mut graphs: ResMut<Assets<AnimationGraph>>,
) {
    let Some(file) = files.get(&figure.0) else { return };
    let clips = GAITS.map(|gait| file.named_animations[gait].clone());
    let (graph, nodes) = AnimationGraph::from_clips(clips.clone());
    commands.insert_resource(Gaits { graph: graphs.add(graph), clips, nodes });
    commands.entity(*walker).insert(WorldAssetRoot(file.scenes[0].clone()));
}

/// Begins all animations of the figure, at rest.
fn begin(
    added: On<Add, AnimationPlayer>,
    mut players: Query<&mut AnimationPlayer>,
    gaits: Res<Gaits>,
    mut commands: Commands,
) {
    let Ok(mut player) = players.get_mut(added.entity) else { return };
    for &node in &gaits.nodes {
        player.play(node).pause();
    }
    commands.entity(added.entity).insert(AnimationGraphHandle(gaits.graph.clone()));
}

/// Blends the animations by the gait of the figure, each at the same phase of it.
fn play(
    figure: Single<&Walker>,
    mut players: Query<&mut AnimationPlayer>,
    gaits: Res<Gaits>,
    clips: Res<Assets<AnimationClip>>,
) {
    let [walk, run] = [figure.walk(), figure.run()];
    let weights = [1.0 - walk, walk - run, run];
    for mut player in &mut players {
        for ((&node, clip), weight) in gaits.nodes.iter().zip(&gaits.clips).zip(weights) {
            let Some((animation, clip)) = player.animation_mut(node).zip(clips.get(clip)) else {
                continue;
            };
            animation.set_weight(weight).set_seek_time(figure.phase / TAU * clip.duration());
        }
    }
}

/// Dyes the cape, and keeps all of its particles.
fn dye(worn: On<Add, ClothSkin>, mut commands: Commands) {
    let all = LodSet { pinned: Some(0), ..default() };
    commands.entity(worn.entity).insert((Design::Bars(vec![CRIMSON]), all));
}
