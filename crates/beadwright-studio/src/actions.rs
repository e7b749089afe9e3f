//! What a person can do, with its key: menus, keys and the list of keys are made from one table.

use crate::app::Studio;
use crate::export::Export;
use crate::jobs::Ask;
use crate::view::Mode;
use crate::view3d::StandardView;
use eframe::egui::{Context, Id, Key, KeyboardShortcut, Modifiers, Popup, ViewportCommand};

/// Something that is done at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Action {
    /// Asks for a model or a project.
    Open,
    /// Writes the project where it lies.
    Save,
    /// Asks where to write the project.
    SaveAs,
    /// Asks for a folder, and writes the program into it.
    ExportProgram,
    /// Takes the last change back.
    Undo,
    /// Takes the last undo back.
    Redo,
    /// Plans anew.
    Plan,
    /// Stops planning.
    Stop,
    /// Part and beads.
    Solid,
    /// One layer.
    Layer,
    /// Two strategies side by side.
    Compare,
    /// Shows everything.
    Fit,
    /// From above.
    Top,
    /// From the front.
    Front,
    /// From the right.
    Right,
    /// From a corner.
    Corner,
    /// One layer up.
    Up,
    /// One layer down.
    Down,
    /// Lets the torch run, or stops it.
    Play,
    /// Light or dark.
    Theme,
    /// The keys.
    Keys,
    /// Ends the program.
    Quit,
}

/// An action, its text and its key.
pub struct Entry {
    /// What is done.
    pub action: Action,
    /// Key of its text.
    pub text: &'static str,
    /// Its key on the keyboard.
    pub key: Option<KeyboardShortcut>,
}

const fn entry(action: Action, text: &'static str, modifiers: Modifiers, key: Key) -> Entry {
    Entry { action, text, key: Some(KeyboardShortcut::new(modifiers, key)) }
}

/// All of them.
pub const ENTRIES: [Entry; 22] = [
    entry(Action::Open, "open", Modifiers::COMMAND, Key::O),
    entry(Action::SaveAs, "save-as", Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S),
    entry(Action::Save, "save", Modifiers::COMMAND, Key::S),
    entry(Action::ExportProgram, "export-program", Modifiers::COMMAND, Key::E),
    entry(Action::Redo, "redo", Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z),
    entry(Action::Undo, "undo", Modifiers::COMMAND, Key::Z),
    entry(Action::Plan, "plan", Modifiers::NONE, Key::F5),
    entry(Action::Stop, "stop", Modifiers::NONE, Key::Escape),
    entry(Action::Solid, "view-solid", Modifiers::NONE, Key::F2),
    entry(Action::Layer, "view-layer", Modifiers::NONE, Key::F3),
    entry(Action::Compare, "view-compare", Modifiers::NONE, Key::F4),
    entry(Action::Fit, "fit", Modifiers::NONE, Key::F),
    entry(Action::Top, "view-top", Modifiers::NONE, Key::Num7),
    entry(Action::Front, "view-front", Modifiers::NONE, Key::Num1),
    entry(Action::Right, "view-right", Modifiers::NONE, Key::Num3),
    entry(Action::Corner, "view-corner", Modifiers::NONE, Key::Num0),
    entry(Action::Up, "layer-up", Modifiers::NONE, Key::PageUp),
    entry(Action::Down, "layer-down", Modifiers::NONE, Key::PageDown),
    entry(Action::Play, "play", Modifiers::NONE, Key::Space),
    entry(Action::Theme, "theme", Modifiers::COMMAND, Key::T),
    entry(Action::Keys, "keys", Modifiers::NONE, Key::F1),
    entry(Action::Quit, "quit", Modifiers::COMMAND, Key::Q),
];

/// The entry of an action.
pub fn find(action: Action) -> Option<&'static Entry> {
    ENTRIES.iter().find(|entry| entry.action == action)
}

/// Whether Escape was pressed just now. A number field that is left by it takes what was typed a frame later, since its focus
/// counts as lost for two frames (egui 0.37); who asks this refuses it.
pub fn escaped(ctx: &Context) -> bool {
    let (now, then) = (ctx.cumulative_pass_nr(), ctx.data(|data| data.get_temp::<u64>(Id::unique("escaped"))));
    then.is_some_and(|then| now.saturating_sub(then) < 3)
}

/// The actions whose keys were pressed. Keys without Ctrl belong to a text field while one is being edited, and to a menu
/// while one is open: Escape leaves them.
pub fn pressed(ctx: &Context) -> Vec<Action> {
    if ctx.input(|input| input.key_pressed(Key::Escape)) {
        let now = ctx.cumulative_pass_nr();
        ctx.data_mut(|data| data.insert_temp(Id::unique("escaped"), now));
    }
    let typing = ctx.egui_wants_keyboard_input() || Popup::is_any_open(ctx);
    // Escape takes the focus before anything else hears of it, and belongs to the field all the same.
    let id = Id::unique("typing");
    let before = ctx.data_mut(|data| std::mem::replace(data.get_temp_mut_or_default(id), typing));
    let typing = typing || before;
    let meant = |entry: &&Entry| {
        let Some(key) = entry.key else { return false };
        let free = !typing || key.modifiers.command;
        free && ctx.input_mut(|input| input.consume_shortcut(&key))
    };
    ENTRIES.iter().filter(meant).map(|entry| entry.action).collect()
}

impl Studio {
    /// Does what was asked for.
    pub fn act(&mut self, action: Action) {
        match action {
            Action::Open => self.ask(Ask::Open),
            Action::Save => match self.file.clone() {
                Some(path) => self.save_to(&path),
                None => self.ask(Ask::SaveProject),
            },
            Action::SaveAs => self.ask(Ask::SaveProject),
            Action::ExportProgram => {
                let dialect = self.view.dialect.clone();
                self.exporting = Export::Program(dialect);
                self.ask(Ask::Folder);
            }
            Action::Undo => {
                let undone = self.project.undo();
                self.went(undone);
            }
            Action::Redo => {
                let redone = self.project.redo();
                self.went(redone);
            }
            Action::Plan => self.replan(),
            Action::Stop => {
                self.planner.cancel();
                self.plan.progress = None;
                if let Some(other) = &mut self.other {
                    other.planner.cancel();
                    other.plan.progress = None;
                }
                self.view.playing = false;
            }
            Action::Solid => self.view.mode = Mode::Solid,
            Action::Layer => self.view.mode = Mode::Layer,
            Action::Compare => self.view.mode = Mode::Compare,
            Action::Fit => {
                self.flat.fit();
                self.solid.fit();
            }
            Action::Top => self.look(StandardView::Top),
            Action::Front => self.look(StandardView::Front),
            Action::Right => self.look(StandardView::Right),
            Action::Corner => self.look(StandardView::Iso),
            Action::Up => self.view.step_layer(1, self.plan.layer_count()),
            Action::Down => self.view.step_layer(-1, self.plan.layer_count()),
            Action::Play => {
                let starts = !self.view.playing && self.plan.summary.is_some();
                self.view.play(starts, &self.plan.scene);
            }
            Action::Theme => {
                self.settings.light = !self.settings.light;
                self.apply_theme();
                self.store.keep_settings(&self.settings);
            }
            Action::Keys => self.view.keys = !self.view.keys,
            Action::Quit => self.ctx.send_viewport_cmd(ViewportCommand::Close),
        }
    }

    /// A step of the history was taken.
    fn went(&mut self, gone: bool) {
        // Before the file was opened there was another project: saving must not put that one into the file.
        if self.project.steps() < self.opened {
            self.file = None;
        }
        self.refused = None;
        if gone {
            self.replan();
        }
    }

    fn look(&mut self, from: StandardView) {
        self.solid.camera.set_view(from);
        self.solid.fit();
    }
}
