//! `beadwright studio --serve`, asked over a plain socket as a browser would.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use tempfile::TempDir;

/// A running server, ended when dropped.
struct Served {
    child: Child,
    address: String,
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill().and_then(|()| self.child.wait());
    }
}

impl Served {
    fn of(folder: &Path) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_beadwright"));
        command.args(["studio", "--serve", "0", "--pages"]).arg(folder).stdout(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address = line.split("http://").nth(1).and_then(|rest| rest.split('/').next()).unwrap().to_owned();
        Self { child, address }
    }

    /// Status, head and body of the answer to a request line.
    fn ask(&self, line: &str) -> (u32, String, Vec<u8>) {
        self.ask_of(&self.address, line)
    }

    /// The same with another name of the machine.
    fn ask_of(&self, host: &str, line: &str) -> (u32, String, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        write!(stream, "{line} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").unwrap();
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).unwrap();
        let end = bytes.windows(4).position(|four| four == b"\r\n\r\n").unwrap();
        let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        (status, head.to_lowercase(), bytes[end + 4..].to_vec())
    }
}

fn page() -> TempDir {
    let outer = TempDir::new().unwrap();
    let folder = outer.path().join("page");
    fs::create_dir(&folder).unwrap();
    fs::write(outer.path().join("secret.html"), "secret").unwrap();
    fs::write(folder.join("index.html"), "<canvas>").unwrap();
    fs::write(folder.join("studio.js"), "start()").unwrap();
    fs::write(folder.join("studio_bg.wasm"), [0, b'a', b's', b'm', 255]).unwrap();
    fs::write(folder.join("notes.txt"), "not of the page").unwrap();
    outer
}

#[test]
fn the_files_of_the_page_come_with_their_types() {
    let folder = page();
    let served = Served::of(&folder.path().join("page"));
    assert!(served.address.starts_with("127.0.0.1:"), "{}", served.address);
    for (path, kind, content) in [
        ("/", "text/html; charset=utf-8", &b"<canvas>"[..]),
        ("/index.html?open=propeller&fill.strategy=zigzag", "text/html; charset=utf-8", b"<canvas>"),
        ("/studio.js", "text/javascript; charset=utf-8", b"start()"),
        ("/studio_bg.wasm", "application/wasm", &[0, b'a', b's', b'm', 255]),
    ] {
        let (status, head, body) = served.ask(&format!("GET {path}"));
        assert_eq!((status, &body[..]), (200, content), "{path}");
        assert!(head.contains(&format!("content-type: {kind}\r\n")), "{path}: {head}");
        let (status, _, body) = served.ask(&format!("HEAD {path}"));
        assert_eq!((status, body.len()), (200, 0), "{path}");
    }
}

#[test]
fn nothing_else_is_handed_out() {
    let folder = page();
    let served = Served::of(&folder.path().join("page"));
    for path in [
        "/../secret.html",
        "/%2e%2e/secret.html",
        "/..%2fsecret.html",
        "//etc/passwd",
        "/./../secret.html",
        "/..\\secret.html",
        "/notes.txt",
        "/none.html",
        "/page/",
    ] {
        let (status, _, body) = served.ask(&format!("GET {path}"));
        assert_eq!(status, 404, "{path}");
        assert!(!String::from_utf8_lossy(&body).contains("secret"), "{path}");
    }
    assert_eq!(served.ask("POST /index.html").0, 405);
    // It still answers.
    assert_eq!(served.ask("GET /").0, 200);
}

/// A page elsewhere may give its own name this machine's address: it is not answered.
#[test]
fn only_its_own_host_is_answered() {
    let folder = page();
    let served = Served::of(&folder.path().join("page"));
    let port = served.address.split(':').next_back().unwrap();
    for host in [served.address.clone(), format!("localhost:{port}"), format!("LocalHost:{port}")] {
        assert_eq!(served.ask_of(&host, "GET /").0, 200, "{host}");
    }
    let other = [format!("evil.example:{port}"), "localhost".to_owned(), "127.0.0.1:1".to_owned(), String::new()];
    for host in other.iter().map(String::as_str).chain([&*format!("localhost.evil.example:{port}")]) {
        let (status, _, body) = served.ask_of(host, "GET /");
        assert!(status == 403 && !body.windows(8).any(|eight| eight == b"<canvas>"), "{host}: {status}");
    }
}

#[cfg(unix)]
#[test]
fn links_lead_nowhere_else() {
    use std::os::unix::fs::symlink;
    let folder = page();
    let page = folder.path().join("page");
    symlink(folder.path().join("secret.html"), page.join("outside.html")).unwrap();
    symlink(folder.path(), page.join("up")).unwrap();
    symlink(page.join("studio.js"), page.join("inside.js")).unwrap();
    let served = Served::of(&page);
    assert_eq!(served.ask("GET /outside.html").0, 404);
    assert_eq!(served.ask("GET /up/secret.html").0, 404);
    assert_eq!(served.ask("GET /inside.js").0, 200);
}

#[test]
fn an_obstacle_is_reported_with_its_remedy() {
    let empty = TempDir::new().unwrap();
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_beadwright"));
        let output = command.arg("studio").args(arguments).current_dir(&empty).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (status, said) = run(&["--serve", "--pages", "."]);
    assert_eq!(status, Some(1));
    assert!(said.contains("there is no index.html") && said.contains("crates/beadwright-studio/web/build"), "{said}");
    let folder = page();
    let served = Served::of(&folder.path().join("page"));
    let taken = served.address.split(':').next_back().unwrap();
    let (status, said) = run(&["--serve", taken, "--pages", folder.path().join("page").to_str().unwrap()]);
    assert_eq!(status, Some(1));
    assert!(said.contains(&format!("port {taken} cannot be used")), "{said}");
    assert_eq!(run(&["--serve", "70000"]).0, Some(2));
}
