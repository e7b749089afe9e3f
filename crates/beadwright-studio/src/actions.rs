//! What the user can do. Panels put requests into a queue; menus, keys and the list of keys are made from one table.

use crate::export::Export;
use crate::jobs::Ask;
use crate::remedy::Change;
use crate::text::Language;
use beadwright::fill::StrategyName;
use beadwright::model::Placement;
use eframe::egui::{Context, Id, Key, KeyboardShortcut, Modifiers, Popup};
use std::path::PathBuf;

/// Something the user asks the program to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Asks for a model or a project.
    Open,
    /// Writes the project into its file.
    Save,
    /// Asks where to write the project.
    SaveAs,
    /// Asks for a folder, and writes the program into it.
    ExportProgram,
    /// Undoes the last change.
    Undo,
    /// Redoes the last undone change.
    Redo,
    /// Plans again.
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
    /// Plays the torch, or stops it.
    Play,
    /// Switches between light and dark.
    Theme,
    /// Shows or hides the list of keys.
    Keys,
    /// Shows or hides the handles that move and turn the part.
    PlaceTool,
    /// Ends the program.
    Quit,
    /// Asks for a file.
    Ask(Ask),
    /// Continues with a path that was typed; without one, gives up asking.
    Answer(Option<PathBuf>),
    /// Writes something into the folder named in the panel, or asks for one.
    Export(Export),
    /// Opens a model or a project.
    OpenFile(PathBuf),
    /// Opens an example part.
    OpenExample(&'static str),
    /// Switches to another language.
    Speak(Language),
    /// Sets a value of the profile: its key, and the value as in TOML.
    SetValue(String, String),
    /// Removes a value from the profile, so that its default applies.
    ResetValue(String),
    /// Removes several values from the profile.
    ResetValues(Vec<String>),
    /// Sets the size of the text, % of the usual.
    TextSize(u32),
    /// Lists all parameters, or only the basic ones.
    AllParameters(bool),
    /// Loads the text of another profile.
    SetProfile(&'static str),
    /// Places the part.
    Place(Placement),
    /// Turns the part the way up in which it costs least.
    Orient,
    /// Looks for divisions of the part into bodies with directions of their own.
    FindDirections,
    /// Gives it up.
    StopDirections,
    /// Welds the part as a division that was found, given by its place among them.
    Divide(usize),
    /// Plans the preform of the part, or the part itself.
    Preform(bool),
    /// Sets the height of a wall made from curves, mm.
    Height(f64),
    /// Plans with a second strategy too.
    CompareWith(StrategyName),
    /// Undoes the step that opened the part, or does not.
    DecideUndo(bool),
    /// Tries a change of the profile.
    Try(Change),
    /// Keeps the change that is tried, or takes it back.
    EndTrial(bool),
    /// Removes a message, by its index.
    Dismiss(usize),
    /// Removes the message on why there is no plan.
    DismissFailure,
    /// Draws the picture of the next example.
    DrawExample,
    /// Computes the steps of the strategies in the layer in view.
    LookCloser,
    /// Plans several models one after another.
    Batch(Vec<PathBuf>),
    /// Gives that up; what is planned stays.
    StopBatch,
    /// Takes the layers that follow a scan of the unfinished build in place of those planned.
    Adapt,
    /// Puts that scan away.
    CloseBuildScan,
    /// Closes the scan.
    CloseScan,
    /// Uses another robot cell.
    TakeCell(&'static str),
    /// Computes temperatures.
    Heat,
    /// Computes how far layers lean from level.
    Level,
    /// Looks for a place of the part that the cell reaches better.
    Suggest,
    /// Computes how plate and part bend.
    Distort,
    /// Gives it up.
    StopDistortion,
    /// Writes the program into its panel.
    List,
    /// Computes what the robot can reach.
    Reach,
    /// Restores the project of a run that crashed.
    BringBack,
    /// Discards that project.
    LetGo,
    /// Exports the program despite its serious findings, or does not.
    DecideExport(bool),
    /// Uses what a damaged model holds.
    AcceptDamaged,
    /// Closes the window, whatever was changed.
    Leave,
    /// Keeps the window open after all.
    GoOn,
}

/// An action, its text and its key.
pub struct Entry {
    /// The action.
    pub action: Action,
    /// Key of its text.
    pub text: &'static str,
    /// Its key on the keyboard.
    pub key: Option<KeyboardShortcut>,
}

const fn entry(action: Action, text: &'static str, modifiers: Modifiers, key: Key) -> Entry {
    Entry { action, text, key: Some(KeyboardShortcut::new(modifiers, key)) }
}

/// All entries.
pub static ENTRIES: [Entry; 23] = [
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
    entry(Action::PlaceTool, "place", Modifiers::NONE, Key::M),
    entry(Action::Up, "layer-up", Modifiers::NONE, Key::PageUp),
    entry(Action::Down, "layer-down", Modifiers::NONE, Key::PageDown),
    entry(Action::Play, "play", Modifiers::NONE, Key::Space),
    entry(Action::Theme, "theme", Modifiers::COMMAND, Key::T),
    entry(Action::Keys, "keys", Modifiers::NONE, Key::F1),
    entry(Action::Quit, "quit", Modifiers::COMMAND, Key::Q),
];

/// The entry of an action.
pub fn find(action: &Action) -> Option<&'static Entry> {
    ENTRIES.iter().find(|entry| entry.action == *action)
}

/// Whether Escape was pressed just now. A number field left with Escape still takes over what was typed, one frame
/// later, since its focus counts as lost for two frames (egui 0.37); callers use this to refuse that value.
pub fn escaped(ctx: &Context) -> bool {
    let (now, then) = (ctx.cumulative_pass_nr(), ctx.data(|data| data.get_temp::<u64>(Id::unique("escaped"))));
    then.is_some_and(|then| now.saturating_sub(then) < 3)
}

/// The actions whose keys were pressed. While a text field is being edited or a menu is open, keys without Ctrl belong
/// to it: Escape leaves it.
pub fn pressed(ctx: &Context) -> Vec<Action> {
    if ctx.input(|input| input.key_pressed(Key::Escape)) {
        let now = ctx.cumulative_pass_nr();
        ctx.data_mut(|data| data.insert_temp(Id::unique("escaped"), now));
    }
    let typing = ctx.egui_wants_keyboard_input() || Popup::is_any_open(ctx);
    // Escape takes the focus away before this code runs, but still belongs to the field.
    let id = Id::unique("typing");
    let before = ctx.data_mut(|data| std::mem::replace(data.get_temp_mut_or_default(id), typing));
    let typing = typing || before;
    let meant = |entry: &&Entry| {
        let Some(key) = entry.key else { return false };
        let free = !typing || key.modifiers.command;
        free && ctx.input_mut(|input| input.consume_shortcut(&key))
    };
    ENTRIES.iter().filter(meant).map(|entry| entry.action.clone()).collect()
}
