//! `beadwright studio --serve`: hands the studio's page to a browser on this machine, and to nobody else.

use anyhow::{Context, bail, ensure};
use std::fs;
use std::io::Write;
use std::path::{Component, Path, PathBuf};
use tiny_http::{Header, Method, Request, Response, Server};

/// Where the page is relative to the command: as installed, and as `web/build` makes it next to `target/release`.
const PLACES: [&str; 2] = ["studio-web", "../studio-web"];
/// The file that shows that a folder holds the page.
const PAGE: &str = "index.html";

/// Serves the page until the command is ended.
pub(crate) fn run(port: u16, folder: Option<&Path>) -> anyhow::Result<()> {
    let folder = folder.map_or_else(beside, |folder| Ok(folder.to_owned()))?;
    ensure!(
        folder.join(PAGE).is_file(),
        "{}: there is no {PAGE}, so this is not the studio's page; build it with `crates/beadwright-studio/web/build`, which \
         writes target/studio-web",
        folder.display()
    );
    let server = Server::http(("127.0.0.1", port)).map_err(anyhow::Error::from_boxed);
    let server = server.with_context(|| format!("port {port} cannot be used; name another, such as --serve 8321"))?;
    let port = server.server_addr().to_ip().map_or(port, |address| address.port());
    // Links are followed here, once: what a link in the folder leads to must lie below.
    let folder = folder.canonicalize().with_context(|| folder.display().to_string())?;
    println!("The studio is at http://{}/ until this command is ended (Ctrl-C).", server.server_addr());
    std::io::stdout().flush()?;
    for request in server.incoming_requests() {
        // A browser that has left is not a fault.
        let _ = answer(request, &folder, port);
    }
    Ok(())
}

fn beside() -> anyhow::Result<PathBuf> {
    let own = std::env::current_exe().context("the folder of this program is not known")?;
    let places = PLACES.map(|place| own.with_file_name(place));
    match places.iter().find(|place| place.join(PAGE).is_file()) {
        Some(place) => Ok(place.clone()),
        None => bail!(
            "the studio's page was not found at {} or {}; build it with `crates/beadwright-studio/web/build`, which writes \
             target/studio-web, or name its folder with --pages",
            places[0].display(),
            places[1].display()
        ),
    }
}

fn answer(request: Request, folder: &Path, port: u16) -> std::io::Result<()> {
    if !is_own(&request, port) {
        return request.respond(
            Response::from_string("Only requests to this machine's own address are answered.").with_status_code(403),
        );
    }
    if !matches!(request.method(), Method::Get | Method::Head) {
        return request.respond(Response::from_string("Only GET and HEAD are answered.").with_status_code(405));
    }
    match wanted(request.url()).and_then(|path| Some((kind(&path)?, read(folder, &path)?))) {
        Some((kind, bytes)) => {
            let mut response = Response::from_data(bytes);
            // A page that was rebuilt must be loaded again.
            for (name, value) in
                [("Content-Type", kind), ("Cache-Control", "no-cache"), ("X-Content-Type-Options", "nosniff")]
            {
                response.add_header(header(name, value)?);
            }
            request.respond(response)
        }
        None => request.respond(Response::from_string("There is no such file.").with_status_code(404)),
    }
}

/// Whether the request names this machine itself: a foreign page's name may have been made to point to this address.
fn is_own(request: &Request, port: u16) -> bool {
    let host = request.headers().iter().find(|header| header.field.equiv("Host"));
    let own = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
    host.is_some_and(|host| own.iter().any(|own| host.value.as_str().eq_ignore_ascii_case(own)))
}

/// The bytes of a file below the folder, also where a link leads there.
fn read(folder: &Path, path: &Path) -> Option<Vec<u8>> {
    let file = folder.join(path).canonicalize().ok().filter(|file| file.starts_with(folder))?;
    fs::read(file).ok()
}

/// The file that an address asks for, below the folder; `None` for anything outside it.
fn wanted(address: &str) -> Option<PathBuf> {
    let path = address.split(['?', '#']).next()?.strip_prefix('/')?;
    // The page's files have plain names, so an encoded address asks for none of them.
    let plain = path.bytes().all(|b| b.is_ascii_alphanumeric() || b"._-/".contains(&b));
    let path = Path::new(if path.is_empty() { PAGE } else { path });
    let below = path.components().all(|part| matches!(part, Component::Normal(_)));
    (plain && below).then(|| path.to_owned())
}

/// The type that the browser is given, by the extension; nothing else is served.
fn kind(path: &Path) -> Option<&'static str> {
    Some(match path.extension()?.to_str()? {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "wasm" => "application/wasm",
        "ttf" => "font/ttf",
        _ => return None,
    })
}

fn header(name: &str, value: &str) -> std::io::Result<Header> {
    Header::from_bytes(name, value).map_err(|()| std::io::Error::other("a header that is not valid"))
}
