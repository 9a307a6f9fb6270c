//! Runs of every method.

use crate::{
    baselines::Baseline,
    contender::Contender,
    observation::{Observation, Observer},
    product::Product,
    reference::grid::Grid,
    scenes::Scene,
    simulation::in_double,
    timing::Timing,
};

/// Ticks before time is taken.
const WARM_UP: usize = 3;

/// The methods of the thesis, other engines if they are built in, and every option of the product; in a quick
/// run, only options with one pass.
#[must_use]
pub fn contenders(quick: bool) -> Vec<Contender> {
    let mut contenders: Vec<_> = Baseline::catalogue().into_iter().map(Contender::from).collect();
    #[cfg(feature = "peers")]
    contenders.extend(crate::peers::engine::contenders());
    let products = Product::catalogue().into_iter().filter(|it| !quick || it.settings.passes == 1);
    contenders.extend(products.map(Contender::from));
    contenders
}

/// Runs a contender through the scene; none if the contender does not support the scene or would take too
/// long.
#[must_use]
pub fn measure(
    scene: &Scene,
    contender: &Contender,
    time_limit: f64,
) -> Option<(Observation, Timing)> {
    let grid = Grid::new(scene);
    let mut observer = Observer::new(scene, &grid);
    let mut simulation = (contender.start)(scene)?;
    let (mut warm_up, mut time) = (Timing::default(), Timing::default());
    for tick in 0..scene.ticks() {
        // The shortest tick decides: longer ones may have waited for the processor.
        if tick == WARM_UP && warm_up.min() * scene.ticks() as f64 > time_limit * 1e6 {
            return None;
        }
        let timing = if tick < WARM_UP { &mut warm_up } else { &mut time };
        timing.time(|| simulation.tick());
        let [positions, velocities] =
            [simulation.positions(), simulation.velocities()].map(in_double);
        if !observer.observe(&positions, &velocities) {
            break;
        }
    }
    Some((observer.finish(), time))
}
