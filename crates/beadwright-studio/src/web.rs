//! The page in a browser: the studio on a canvas, and the words next to it.
//!
//! The address may say what to open: `?open=propeller` an example part, `?fill.strategy=zigzag` a value of the profile.

use crate::planner::Failure;
use crate::settings::Store;
use crate::studio::Studio;
use eframe::egui;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew, wgpu::Backends};
use js_sys::{Reflect, Uint8Array, global};
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{Document, HtmlCanvasElement, HtmlElement, Response, UrlSearchParams, Window};

/// Starts the page; a worker, which has no window, waits for its orders instead.
pub fn main() {
    std::panic::set_hook(Box::new(|panic| {
        // `worker.js` and the page report it.
        let _ = Reflect::set(&global(), &"reason".into(), &panic.to_string().into());
        web_sys::console::error_1(&panic.to_string().into());
    }));
    if let Some(window) = web_sys::window() {
        spawn_local(async move {
            if let Err(error) = start(window).await {
                let _ = Reflect::apply(&explain(), &JsValue::UNDEFINED, &js_sys::Array::of1(&error));
            }
        });
    }
}

/// The function `explain` of the page, which shows why there is no studio.
fn explain() -> js_sys::Function {
    Reflect::get(&global(), &"explain".into()).unwrap_or_default().unchecked_into()
}

async fn start(window: Window) -> Result<(), JsValue> {
    let document = window.document().ok_or("there is no page")?;
    let canvas: HtmlCanvasElement = document.get_element_by_id("studio").ok_or("there is no canvas")?.unchecked_into();
    let body = document.body().ok_or("there is no page")?;
    if let Some(name) = body.get_attribute("data-font")
        && let Some(font) = font(&window, &name).await
    {
        crate::fonts::hand_over(font);
    }
    let wanted = UrlSearchParams::new_with_str(&window.location().search()?)?;
    let page = document.clone();
    let app: eframe::AppCreator<'_> = Box::new(move |cc| Ok(Box::new(Page::new(cc, page, &wanted))));
    eframe::WebRunner::new().start(canvas, options(), app).await?;
    body.set_class_name("ready");
    Ok(())
}

/// WebGL 2 only: every browser has it, and it is what is tested.
fn options() -> eframe::WebOptions {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = Backends::GL;
    let wgpu_options = WgpuConfiguration { wgpu_setup: WgpuSetup::CreateNew(setup), ..WgpuConfiguration::default() };
    eframe::WebOptions { wgpu_options, ..eframe::WebOptions::default() }
}

/// A font with Chinese characters that is next to the page; without it the page stays English.
async fn font(window: &Window, name: &str) -> Option<Vec<u8>> {
    let response: Response = JsFuture::from(window.fetch_with_str(name)).await.ok()?.unchecked_into();
    let bytes = response.ok().then(|| response.array_buffer().ok()).flatten()?;
    Some(Uint8Array::new(&JsFuture::from(bytes).await.ok()?).to_vec())
}

/// The studio, and what the page says about it to screen readers.
struct Page {
    studio: Studio,
    status: Option<HtmlElement>,
    body: Option<HtmlElement>,
    said: String,
}

impl Page {
    fn new(cc: &eframe::CreationContext<'_>, document: Document, wanted: &UrlSearchParams) -> Self {
        let mut studio = Studio::new(cc, Store::of_user());
        let entries = wanted.entries().into_iter().flatten();
        for entry in entries.map(JsValue::unchecked_into::<js_sys::Array>) {
            match [0, 1].map(|i| entry.get(i).as_string().unwrap_or_default()) {
                [key, name] if key == "open" => studio.open_example(&name),
                [key, value] => studio.set_value(&key, &value),
            }
        }
        let status = document.get_element_by_id("status").map(JsValue::from).map(JsCast::unchecked_into);
        Self { studio, status, body: document.body(), said: String::new() }
    }

    /// The state of things, and the last message.
    fn sentence(&self) -> String {
        let (plan, part) = (self.studio.plan(), self.studio.project().part());
        if let Some(
            Failure::Units(text, _) | Failure::Damaged(text) | Failure::Height(text) | Failure::Sentence(text),
        ) = &plan.failure
        {
            return text.clone();
        }
        let state = match (&plan.progress, &plan.findings) {
            (Some((stage, _)), _) => format!("{part}: {}, {} layers", stage.name(), plan.layers.len()),
            (None, Some(findings)) => format!("{part}: {} layers, {} findings", plan.layers.len(), findings.len()),
            (None, None) if plan.part.is_some() => format!("{part}: stopped"),
            (None, None) => "No part is planned".to_owned(),
        };
        let last = self.studio.messages().last().map_or(String::new(), |message| format!(" {}", message.text));
        format!("{state}.{last}")
    }

    fn announce(&mut self) {
        let sentence = self.sentence();
        if sentence != self.said {
            if let Some(status) = &self.status {
                status.set_inner_text(&sentence);
            }
            self.said = sentence;
        }
        // The page asks before it is left with unsaved changes.
        if let Some(body) = &self.body {
            let _ = body.toggle_attribute_with_force("data-changed", self.studio.is_changed());
        }
    }
}

impl eframe::App for Page {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.studio.ui(ui, frame);
        self.announce();
    }
}
