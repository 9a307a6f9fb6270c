//! The panel in a context of egui without a window: its text is read, and its buttons are clicked.

use bevy_app::App;
use bevy_asset::AssetId;
use bevy_bunting::prelude::*;
use bevy_bunting_inspector::bevy_egui::{
    EguiContext, EguiPrimaryContextPass, PrimaryEguiContext, egui,
};
use bevy_bunting_inspector::{
    ClothInspectorPlugin, ClothSelectionPlugin, ClothStrainPlugin, PanelState, SelectedCloth,
    cloth_panel,
};
use bevy_ecs::prelude::*;
use bevy_inspector_egui::DefaultInspectorConfigPlugin;
use bevy_mesh::Mesh;
use bunting_tests::run;
use egui::epaint::{ClippedShape, Shape};
use egui::{Event, Modifiers, PointerButton, Pos2, RawInput, Rect, Vec2};

use crate::tuning::{file, world_with_flag};

/// The panel, and a context of egui.
struct Panel {
    app: App,
    flag: Entity,
    context: egui::Context,
}

impl Panel {
    fn new() -> Self {
        let (mut app, flag) = world_with_flag();
        // Bevy's asset plugins register handles, and bevy-inspector-egui expects that.
        app.register_type::<AssetId<Mesh>>();
        app.add_plugins((DefaultInspectorConfigPlugin, ClothSelectionPlugin, ClothStrainPlugin))
            .init_resource::<PanelState>();
        app.world_mut().entity_mut(flag).insert(Name::new("Ensign"));
        run(&mut app, 5);
        Self { app, flag, context: egui::Context::default() }
    }

    /// Shows a frame, and returns its shapes.
    fn frame(&mut self, events: Vec<Event>) -> Vec<ClippedShape> {
        let screen = Rect::from_min_size(Pos2::ZERO, Vec2::new(900.0, 4000.0));
        let input = RawInput { screen_rect: Some(screen), events, ..RawInput::default() };
        let world = self.app.world_mut();
        self.context.run_ui(input, |ui| cloth_panel(world, ui)).shapes
    }

    /// The texts of a frame and their places.
    fn texts(&mut self) -> Vec<(String, Pos2)> {
        let mut texts = Vec::new();
        for shape in self.frame(Vec::new()) {
            collect_texts(&shape.shape, &mut texts);
        }
        texts
    }

    fn shows(&mut self, part: &str) -> bool {
        self.texts().iter().any(|(text, _)| text.contains(part))
    }

    /// Clicks on the first text that contains a part.
    fn click(&mut self, part: &str) {
        self.drag(part, 0.0);
    }

    /// Drags the first text that contains a part to the right, points.
    fn drag(&mut self, part: &str, by: f32) {
        let texts = self.texts();
        let found = texts.iter().find(|(text, _)| text.contains(part));
        let &(_, from) = found.unwrap_or_else(|| panic!("no {part} among {texts:?}"));
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        let press = |pos, pressed| Event::PointerButton { pos, button, pressed, modifiers };
        let to = from + Vec2::X * by;
        self.frame(vec![Event::PointerMoved(from)]);
        self.frame(vec![press(from, true)]);
        self.frame(vec![Event::PointerMoved(to)]);
        self.frame(vec![press(to, false)]);
        // What opens is animated.
        (0..30).for_each(|_| drop(self.frame(Vec::new())));
    }

    fn material(&self) -> ClothMaterial {
        *self.app.world().get(self.flag).expect("a material")
    }
}

fn collect_texts(shape: &Shape, texts: &mut Vec<(String, Pos2)>) {
    match shape {
        Shape::Text(text) => {
            let middle = text.pos + text.galley.size() / 2.0;
            texts.push((text.galley.text().to_owned(), middle));
        }
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| collect_texts(shape, texts)),
        _ => {}
    }
}

#[test]
fn cloths_are_listed_and_selected_and_their_components_shown() {
    let mut panel = Panel::new();
    assert!(panel.shows("Cloths: 1") && panel.shows("No cloth is selected"));
    assert!(panel.shows("Ensign · level 0 · "), "{:?}", panel.texts());
    assert!(panel.shows("substeps by"));
    assert!(!panel.shows("ClothMaterial"));
    panel.click("Ensign");
    assert_eq!(panel.app.world().resource::<SelectedCloth>().0, Some(panel.flag));
    assert!(panel.shows("ClothMaterial") && panel.shows("LodSet"), "{:?}", panel.texts());
    panel.app.world_mut().entity_mut(panel.flag).insert(ClothPaused);
    assert!(panel.shows("paused"));
}

#[test]
fn a_parameter_is_dragged_and_counts_as_changed() {
    let mut panel = Panel::new();
    panel.click("Ensign");
    assert!(panel.shows("area_density"), "{:?}", panel.texts());
    let before = panel.material().0.area_density;
    let is_changed = |panel: &Panel| {
        let flag = panel.app.world().entity(panel.flag);
        flag.get_ref::<ClothMaterial>().expect("a material").is_changed()
    };
    panel.app.world_mut().clear_trackers();
    panel.frame(Vec::new());
    assert!(!is_changed(&panel), "what is only shown stays as it is");
    panel.drag("0.113", 20.0);
    let after = panel.material().0.area_density;
    assert!(after > before, "{after} kg/m² after {before}");
    assert!(is_changed(&panel));
}

#[test]
fn presets_are_saved_and_loaded_by_buttons() {
    let mut panel = Panel::new();
    let file = file("panel.ron").display().to_string();
    panel.app.world_mut().resource_mut::<PanelState>().file = file.clone();
    panel.click("Save");
    assert!(panel.app.world().resource::<PanelState>().message.is_empty(), "nothing to save");
    panel.click("Ensign");
    panel.click("silk");
    assert_eq!(panel.material(), ClothMaterial::SILK);
    panel.click("Save");
    assert!(panel.shows(&format!("{file}: saved")), "{:?}", panel.texts());
    panel.click("denim");
    assert_eq!(panel.material(), ClothMaterial::DENIM);
    panel.click("Load");
    assert!(panel.shows("loaded"));
    assert_eq!(panel.material(), ClothMaterial::SILK);
    std::fs::write(&file, "nothing").expect("a file");
    panel.click("Load");
    assert!(panel.shows("it must have the form"), "{:?}", panel.texts());
}

#[test]
fn the_brush_is_shown_for_the_selected_cloth() {
    let mut panel = Panel::new();
    panel.click("Ensign");
    assert!(!panel.shows("Paint pins"), "nothing paints without ClothDragPlugin");
    panel.app.init_resource::<PinBrush>();
    panel.click("Paint pins");
    let brush = panel.app.world().resource::<PinBrush>().clone();
    assert_eq!((brush.stroke, brush.only), (PinStroke::Paint, Some(panel.flag)));
    panel.click("Drag");
    assert_eq!(panel.app.world().resource::<PinBrush>().stroke, PinStroke::Off);
}

#[test]
fn settings_winds_and_plots_are_shown() {
    let mut panel = Panel::new();
    panel.click("All cloths");
    assert!(panel.shows("gravity") && panel.shows("refine_above") && panel.shows("held_back"));
    panel.click("Winds");
    panel.click("Breeze");
    assert!(panel.shows("WindField"), "{:?}", panel.texts());
    panel.click("Sets");
    assert!(panel.shows("tick ") && panel.shows("publish "));
    panel.app.insert_resource(SelectedCloth(Some(panel.flag)));
    run(&mut panel.app, 20);
    let lines = panel.frame(Vec::new());
    let longest = lines.iter().filter_map(|shape| match &shape.shape {
        Shape::Path(path) => Some(path.points.len()),
        _ => None,
    });
    assert!(longest.max().is_some_and(|points| points >= 20), "a line through 20 ticks");
}

#[test]
fn the_plugin_shows_the_panel_in_the_first_context_while_it_is_open() {
    let (mut app, flag) = world_with_flag();
    app.register_type::<AssetId<Mesh>>();
    app.add_plugins(ClothInspectorPlugin);
    app.finish();
    app.insert_resource(SelectedCloth(Some(flag)));
    let world = app.world_mut();
    let entity = world.spawn((EguiContext::default(), PrimaryEguiContext)).id();
    let context = world.get_mut::<EguiContext>(entity).expect("a context").get_mut().clone();
    let mut shows = |is_open| {
        world.resource_mut::<PanelState>().is_open = is_open;
        let mut texts = Vec::new();
        // Windows of egui come and go within some frames.
        for _ in 0..30 {
            texts.clear();
            let screen = Rect::from_min_size(Pos2::ZERO, Vec2::new(900.0, 900.0));
            context.begin_pass(RawInput { screen_rect: Some(screen), ..RawInput::default() });
            world.run_schedule(EguiPrimaryContextPass);
            let shapes = context.end_pass().shapes;
            shapes.iter().for_each(|shape| collect_texts(&shape.shape, &mut texts));
        }
        ["Cloths: 1", " kg/m²", "0.0000103"]
            .map(|part| texts.iter().any(|(text, _)| text.contains(part)))
    };
    assert_eq!(shows(true), [true; 3], "panel, density, bending stiffness");
    assert_eq!(shows(false), [false; 3]);
}
