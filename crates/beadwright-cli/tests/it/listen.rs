//! `beadwright listen` with a real broker and a real server, both killed and started again: what they accepted is in the log, once, and
//! `beadwright record` reports the rest.

use crate::common::{ok, refused};
use crate::opened_elsewhere::python;
use crate::record::times;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Write as _};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// A program that ends with the test.
struct Running(Child);

impl Running {
    fn kill(mut self) {
        // SIGKILL, which no program can answer.
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        _ = self.0.kill();
        _ = self.0.wait();
    }
}

fn free_port() -> u16 {
    TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

fn wait_for(what: &str, such: impl Fn() -> bool) {
    let begun = Instant::now();
    while !such() {
        assert!(begun.elapsed() < Duration::from_secs(40), "{what} did not happen");
        std::thread::sleep(Duration::from_millis(30));
    }
}

/// Begins to listen, and waits until it does.
fn listen(at: &Path, source: &str, more: &[&str]) -> Running {
    let said = at.join("said.txt");
    let child = Command::new(env!("CARGO_BIN_EXE_beadwright"))
        .current_dir(at)
        .args([&["listen", source, "-o", "logs"], more].concat())
        .stdout(Stdio::null())
        .stderr(File::create(&said).unwrap())
        .spawn();
    let running = Running(child.unwrap());
    let text = || fs::read_to_string(&said).unwrap();
    wait_for("listening", || text().contains("listening to") || text().contains("error"));
    assert!(text().contains("listening to"), "{}", text());
    running
}

/// Ends listening as a person does.
fn ctrl_c(listener: Running) {
    let Running(child) = &mut { listener };
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert!(child.wait().unwrap().success());
}

/// A row of the cell: seconds since the build began, a number of its own, and the current.
type Row = (f64, usize, f64);

/// What the cell would publish while a plan is welded: five rows a second.
fn welded(at: &Path) -> (Vec<Row>, usize) {
    ok(at, &["example", "cross", "-o", "cross.stl"]);
    let set = ["--set", "process.current=150"];
    ok(at, &[&["plan", "cross.stl", "-s", "contour", "--no-deposit", "-o", "out"], &set[..]].concat());
    let passes = times(at, [0.0, 0.0]);
    let rows = (0..(passes[passes.len() - 1][1] * 5.0) as usize + 20).map(|n| {
        let time = n as f64 / 5.0;
        let burns = passes.iter().any(|[from, to]| (*from..*to).contains(&time));
        (time, n + 1, if burns { 150.0 } else { 0.0 })
    });
    (rows.collect(), passes.len())
}

/// The numbers in a log, in its order, with repeats of the same row left out.
fn numbers(at: &Path) -> Vec<usize> {
    let text = fs::read_to_string(at.join("logs/power.csv")).unwrap();
    // A line may be half written while it is read.
    let text = &text[..text.rfind('\n').map_or(0, |end| end + 1)];
    let head: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let column = head.iter().position(|name| *name == "n").unwrap();
    let cell = |line: &str| line.rsplit(',').nth(head.len() - 1 - column)?.parse::<f64>().ok();
    let mut numbers: Vec<usize> = text.lines().skip(1).filter_map(cell).map(|number| number as usize).collect();
    numbers.dedup();
    numbers.retain(|number| *number > 0);
    numbers
}

/// Ends listening, and gives the numbers in the log, which ends with a whole line.
fn all_numbers(at: &Path, listener: Running) -> Vec<usize> {
    ctrl_c(listener);
    assert!(fs::read_to_string(at.join("logs/power.csv")).unwrap().ends_with('\n'));
    numbers(at)
}

/// Whether each number is there once, and in order.
fn each_once(seen: &[usize], expected: &[usize]) {
    let differs = seen.iter().zip(expected).position(|(seen, expected)| seen != expected);
    let around = |of: &[usize]| differs.map(|at| of[at.saturating_sub(3)..(at + 3).min(of.len())].to_vec());
    assert!(
        differs.is_none() && seen.len() == expected.len(),
        "{} of {}: {:?} instead of {:?}",
        seen.len(),
        expected.len(),
        around(seen),
        around(expected)
    );
}

/// What a record finds of the log, by its kinds.
fn found(at: &Path, passes: usize) -> BTreeSet<String> {
    let arguments = ["record", "out/plan.json", "--source", "logs/power.csv", "--json"];
    let said: serde_json::Value = serde_json::from_str(&ok(at, &arguments)).unwrap();
    let record: serde_json::Value = serde_json::from_slice(&fs::read(at.join("record/record.json")).unwrap()).unwrap();
    assert_eq!(record["passes"].as_array().unwrap().len(), passes);
    let kinds = said["findings"].as_array().unwrap().iter().map(|finding| finding["kind"].as_str().map(str::to_owned));
    kinds.flatten().collect()
}

// --- MQTT

const TOPIC: &str = "cell/power";

/// Whether the broker is installed.
fn has_mosquitto() -> bool {
    let there = mosquitto().arg("-h").output().is_ok() && Command::new("mosquitto_pub").arg("--help").output().is_ok();
    assert!(there || std::env::var_os("BEADWRIGHT_BROKER").is_none(), "apt-get install mosquitto mosquitto-clients");
    if !there {
        eprintln!("not listened to: mosquitto and mosquitto-clients are not installed");
    }
    there
}

fn mosquitto() -> Command {
    let own = Path::new("/usr/sbin/mosquitto");
    Command::new(if own.exists() { own } else { Path::new("mosquitto") })
}

/// A broker on a port of its own.
fn new_broker(at: &Path) -> (Running, u16) {
    let own = |_| {
        let port = free_port();
        Some((broker(at, port)?, port))
    };
    (0..5).find_map(own).unwrap()
}

/// A broker that keeps what it has accepted; none if it ends at once, as when another program has taken the port.
fn broker(at: &Path, port: u16) -> Option<Running> {
    let user = Command::new("id").arg("-un").output().unwrap().stdout;
    let settings = format!(
        "listener {port} 127.0.0.1\nallow_anonymous true\npersistence true\npersistence_location {0}/\n\
         autosave_on_changes true\nautosave_interval 1\nmax_queued_messages 0\nlog_dest file {0}/broker.log\nlog_type all\n\
         user {1}\n",
        at.display(),
        String::from_utf8(user).unwrap().trim()
    );
    fs::write(at.join("broker.conf"), settings).unwrap();
    let child = mosquitto().arg("-c").arg(at.join("broker.conf")).stderr(Stdio::null()).spawn();
    let mut running = Running(child.unwrap());
    let begun = Instant::now();
    while running.0.try_wait().unwrap().is_none() {
        if std::net::TcpStream::connect(("127.0.0.1", port)).is_ok() {
            return Some(running);
        }
        assert!(begun.elapsed() < Duration::from_secs(40), "the broker does not answer");
        std::thread::sleep(Duration::from_millis(30));
    }
    None
}

/// Publishes rows; whether the broker accepted them all.
fn publish(port: u16, rows: &[Row]) -> bool {
    let arguments = ["-h", "127.0.0.1", "-p", &port.to_string(), "-q", "1", "-t", TOPIC, "-l"];
    let publisher = Command::new("mosquitto_pub").args(arguments).stdin(Stdio::piped()).stderr(Stdio::null()).spawn();
    let mut publisher = publisher.unwrap();
    let mut lines = String::new();
    for (time, number, current) in rows {
        writeln!(lines, "{{\"t\":{:.1},\"n\":{number},\"power\":{{\"i\":{current}}}}}", 1.8e9 + time).unwrap();
    }
    // A broker that is not there ends the publisher before it reads.
    _ = publisher.stdin.take().unwrap().write_all(lines.as_bytes());
    publisher.wait().unwrap().success()
}

#[test]
fn all_that_a_broker_accepted_is_in_the_log_once_though_both_were_killed() {
    if !has_mosquitto() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let (rows, passes) = welded(at);
    let (running, port) = new_broker(at);
    let source = format!(
        "url = \"mqtt://127.0.0.1:{port}\"\ntime = {{ field = \"t\", unit = \"unix\" }}\n[columns]\n\
         n = {{ topic = \"{TOPIC}\", field = \"n\" }}\ncurrent = {{ topic = \"{TOPIC}\", field = \"power.i\", unit = \"A\" }}\n"
    );
    fs::write(at.join("power.toml"), source).unwrap();
    let part = rows.len() / 4;
    let (first, lost, second, third) =
        (&rows[..part], &rows[part..part + 50], &rows[part + 50..2 * part], &rows[2 * part..]);

    let listener = listen(at, "power.toml", &[]);
    assert!(publish(port, &first[..part - 20]));
    // One by one, and the broker is killed as soon as it has accepted the last.
    assert!(first[part - 20..].iter().all(|row| publish(port, &[*row])));
    running.kill();
    assert!(!publish(port, &lost[..1]), "nothing is accepted while it is dead");
    std::thread::sleep(Duration::from_millis(700));
    let running = broker(at, port).unwrap();
    assert!(publish(port, second));
    wait_for("the second part", || numbers(at).len() == first.len() + second.len());
    listener.kill();
    // What is published while nobody listens.
    assert!(publish(port, &third[..100]));
    let listener = listen(at, "power.toml", &[]);
    assert!(publish(port, &third[100..]));
    let expected: Vec<usize> = [first, second, third].concat().iter().map(|row| row.1).collect();
    wait_for("the third part", || numbers(at).len() >= expected.len());
    let mut seen = all_numbers(at, listener);
    seen.sort_unstable();
    each_once(&seen, &expected);
    let kinds = found(at, passes);
    assert!(kinds.contains("interrupted") && kinds.contains("gap"), "{kinds:?}");
    // The broker saw no message from us.
    drop(running);
    let log = fs::read_to_string(at.join("broker.log")).unwrap();
    assert!(
        log.contains("as beadwright-power") && log.contains("Received PUBLISH from "),
        "the log tells who publishes"
    );
    assert!(!log.contains("Received PUBLISH from beadwright"));
}

#[test]
fn what_cannot_be_listened_to_is_refused_with_its_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let fails = |text: &str| {
        fs::write(at.join("power.toml"), text).unwrap();
        refused(at, &["listen", "power.toml", "--for", "1"], 1)
    };
    let port = free_port();
    let column = "[columns]\ncurrent = { topic = \"a\" }\n";
    let said = fails(&format!("url = \"mqtt://127.0.0.1:{port}\"\n{column}"));
    assert!(said.contains("refused") && said.contains("Check whether the broker runs"), "{said}");
    let node = "[columns]\ncurrent = { node = \"ns=2;s=a\" }\n";
    let said = fails(&format!("url = \"opc.tcp://127.0.0.1:{port}\"\n{node}"));
    assert!(said.contains("the server does not answer"), "{said}");
    assert!(fails(&format!("url = \"http://x\"\n{column}")).contains("mqtt://HOST:PORT or opc.tcp://HOST:PORT"));
    assert!(fails(&format!("url = \"mqtt://x\"\n{node}")).contains("columns.current: topic is expected"));
    assert!(
        fails("url = \"mqtt://x\"\n[columns]\ncurrent = { topic = \"a\", unit = \"N\" }\n").contains("columns.current")
    );
    assert!(fails("url = \"mqtt://x\"\n[columns]\ncurrent = { topic = \"a/#\" }\n").contains("without + and #"));
    assert!(
        fails("url = \"opc.tcp://x\"\n[columns]\ncurrent = { node = \"Power\" }\n").contains("is not a node such as")
    );
    assert!(fails("[columns]\n").contains("url"));
    assert!(fails(&format!("url = \"mqtt://x\"\nclient = \"\"\n{column}")).contains("client is empty: give a name"));
    let said = fails(&format!("url = \"mqtt://x\"\n{column}i = {{ topic = \"b\" }}\n"));
    assert!(said.contains("columns.current and columns.i are the same quantity"), "{said}");
}

#[test]
fn messages_that_cannot_be_read_and_silent_topics_are_named() {
    if !has_mosquitto() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let (_running, port) = new_broker(at);
    let source = format!(
        "url = \"mqtt://127.0.0.1:{port}\"\nsilent = 1\n[columns]\ncurrent = {{ topic = \"i\" }}\nvoltage = {{ topic = \"u\" }}\n"
    );
    fs::write(at.join("power.toml"), source).unwrap();
    let listener = listen(at, "power.toml", &["--until-idle", "15"]);
    for payload in ["180,5", "much", "181"] {
        let arguments = ["-h", "127.0.0.1", "-p", &port.to_string(), "-t", "i", "-m", payload];
        assert!(Command::new("mosquitto_pub").args(arguments).status().unwrap().success());
    }
    let Running(child) = &mut { listener };
    assert!(child.wait().unwrap().success());
    let said = fs::read_to_string(at.join("said.txt")).unwrap();
    assert!(said.contains("power: i: \"much\" is not a number."), "{said}");
    assert!(said.contains("power: u: nothing was heard for 1 s."), "{said}");
    let log = fs::read_to_string(at.join("logs/power.csv")).unwrap();
    assert!(log.starts_with("time,event,note,current,voltage\n"), "{log}");
    assert!(log.contains("Z,,,180.5,\n") && log.contains("Z,,,181,\n") && log.contains(",unreadable,"), "{log}");
}

#[test]
fn a_log_goes_on_after_a_half_line_and_ctrl_c_ends_it_whole() {
    if !has_mosquitto() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let (_running, port) = new_broker(at);
    let source = |name: &str| {
        format!(
            "url = \"mqtt://127.0.0.1:{port}\"\ntime = {{ field = \"at\", unit = \"iso\" }}\n[columns]\n\
             {name} = {{ topic = \"t\", field = \"values.0\" }}\n"
        )
    };
    fs::write(at.join("power.toml"), source("temperature")).unwrap();
    fs::create_dir(at.join("logs")).unwrap();
    // As a power cut leaves it.
    let before = "time,event,note,temperature\n2026-11-28T10:00:00.000000Z,,,180\n2026-11-28T10:00:01.0";
    fs::write(at.join("logs/power.csv"), before).unwrap();
    // Another source fails: the log stays as it is, and the broker keeps what is published until listening begins again.
    let other = format!("url = \"mqtt://127.0.0.1:{}\"\n[columns]\ncurrent = {{ topic = \"t\" }}\n", free_port());
    fs::write(at.join("other.toml"), other).unwrap();
    let said = refused(at, &["listen", "power.toml", "other.toml", "-o", "logs"], 1);
    assert!(said.contains("Check whether the broker runs"), "{said}");
    assert!(!fs::read_to_string(at.join("logs/power.csv")).unwrap().contains("interrupted"));
    let payload = "{\"at\":\"2026-11-28T11:00:05.5+01:00\",\"values\":[200.5,1]}";
    let arguments = ["-h", "127.0.0.1", "-p", &port.to_string(), "-q", "1", "-t", "t", "-m", payload];
    assert!(Command::new("mosquitto_pub").args(arguments).status().unwrap().success());
    let listener = listen(at, "power.toml", &[]);
    let log = || fs::read_to_string(at.join("logs/power.csv")).unwrap();
    wait_for("the row", || log().ends_with("2026-11-28T10:00:05.500000Z,,,200.5\n"));
    ctrl_c(listener);
    let text = log();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines.len(), lines[1]), (5, "2026-11-28T10:00:00.000000Z,,,180"), "{text}");
    assert!(lines[2].starts_with("2026-11-28T10:00:00.000000Z,interrupted,"), "{text}");
    assert!(lines[3].starts_with("2026-11-28T10:00:05.500000Z,resumed,"), "{text}");
    // A log of other columns is left as it is.
    fs::write(at.join("power.toml"), source("current")).unwrap();
    let said = refused(at, &["listen", "power.toml", "--for", "1", "-o", "logs"], 1);
    assert!(said.contains("power.csv: the log has other columns"), "{said}");
    assert_eq!(log(), text);
}

// --- OPC UA

/// The server, driven by rows.
struct Server {
    running: Running,
    rows: ChildStdin,
    said: Receiver<String>,
    changed: bool,
}

impl Server {
    fn new(port: u16) -> Self {
        let mut python = Command::new("python3");
        if let Some(packages) = std::env::var_os("BEADWRIGHT_PYTHON_PACKAGES") {
            python.env("PYTHONPATH", packages);
        }
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/opcua_server.py");
        let child = python.args([script, &port.to_string()]).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = child.stderr(Stdio::null()).spawn().unwrap();
        let (rows, lines) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()).lines());
        let (tell, said) = channel();
        // Ends with the server.
        std::thread::spawn(move || lines.map_while(Result::ok).try_for_each(|line| tell.send(line)));
        let mut server = Self { running: Running(child), rows, said, changed: false };
        server.wait_for("ready", 1);
        server
    }

    /// Sets the variables row by row.
    fn set(&mut self, begin: f64, rows: &[Row]) {
        let line = |(time, number, current): &Row| format!("{:.3},n={number},current={current}", begin + time);
        self.tell(&rows.iter().map(line).collect::<Vec<_>>());
        // So long that all of it is sent.
        std::thread::sleep(Duration::from_millis(800));
    }

    fn cut(&mut self) {
        self.tell(&["cut".to_owned()]);
    }

    fn tell(&mut self, lines: &[String]) {
        self.rows.write_all((lines.join("\n") + "\n").as_bytes()).unwrap();
        self.wait_for("done", lines.len());
    }

    fn wait_for(&mut self, word: &str, mut count: usize) {
        while count > 0 {
            let line = self.said.recv_timeout(Duration::from_secs(40)).expect("the server ended or hangs");
            self.changed |= ["written", "called"].contains(&line.trim());
            count -= usize::from(line.trim() == word);
        }
    }
}

fn has_asyncua(at: &Path) -> bool {
    let there = python(at, &["-c", "import asyncua"]).is_ok_and(|asked| asked.status.success());
    assert!(there || std::env::var_os("BEADWRIGHT_PYTHON_PACKAGES").is_none(), "pip install asyncua");
    if !there {
        eprintln!("not listened to: asyncua is not installed (BEADWRIGHT_PYTHON_PACKAGES names a folder with it)");
    }
    there
}

#[test]
fn a_server_is_heard_again_after_its_connections_were_cut_and_after_it_was_killed() {
    let folder = tempfile::tempdir().unwrap();
    let (at, port) = (folder.path(), free_port());
    if !has_asyncua(at) {
        return;
    }
    let (rows, passes) = welded(at);
    let source = |node: &str| {
        format!(
            "url = \"opc.tcp://127.0.0.1:{port}/\"\n[columns]\nn = {{ node = \"ns=2;s=Power.n\" }}\n\
             current = {{ node = \"ns=2;s={node}\", unit = \"A\" }}\n"
        )
    };
    fs::write(at.join("wrong.toml"), source("Power.curent")).unwrap();
    fs::write(at.join("power.toml"), source("Power.current")).unwrap();
    let mut server = Server::new(port);
    let said = refused(at, &["listen", "wrong.toml", "--for", "1"], 1);
    assert!(said.contains("ns=2;s=Power.curent cannot be read"), "{said}");

    // The clock of the cell is an hour ahead.
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_secs_f64();
    let begin = (now + 3600.0).floor();
    let part = rows.len() / 3;
    let (first, second, lost, third) =
        (&rows[..part], &rows[part..2 * part], &rows[2 * part..2 * part + 50], &rows[2 * part + 50..]);
    let listener = listen(at, "power.toml", &[]);
    server.set(begin, first);
    server.cut();
    // It goes on without anybody who listens.
    server.set(begin, second);
    wait_for("the second part", || numbers(at).len() == first.len() + second.len());
    let Server { running, changed, .. } = server;
    running.kill();
    assert!(!changed && !lost.is_empty());
    let mut server = Server::new(port);
    wait_for("the server to be heard again", || {
        fs::read_to_string(at.join("said.txt")).unwrap().contains("The server kept nothing")
    });
    server.set(begin, third);
    let expected: Vec<usize> = [first, second, third].concat().iter().map(|row| row.1).collect();
    wait_for("the third part", || numbers(at).len() >= expected.len());
    each_once(&all_numbers(at, listener), &expected);
    assert!(!server.changed, "nothing was written or called");
    let kinds = found(at, passes);
    assert!(kinds.contains("interrupted") && kinds.contains("gap"), "{kinds:?}");
}

#[test]
fn words_are_written_once_and_all_rows_have_the_clock_of_the_values() {
    let folder = tempfile::tempdir().unwrap();
    let (at, port) = (folder.path(), free_port());
    if !has_asyncua(at) {
        return;
    }
    let node = |name: &str| format!("{name} = {{ node = \"ns=2;s=Power.{name}\" }}\n");
    let columns = ["n", "current", "event"].map(node).concat();
    fs::write(at.join("power.toml"), format!("url = \"opc.tcp://127.0.0.1:{port}/\"\n[columns]\n{columns}")).unwrap();
    let mut server = Server::new(port);
    let listener = listen(at, "power.toml", &[]);
    let log = || fs::read_to_string(at.join("logs/power.csv")).unwrap();
    // The clock of the cell is years behind that of the server: 2023-11-14T22:13:20Z.
    let begin = 1.7e9;
    let told = ["event=arc_on", "n=1,current=150", "n=2,current=151", "n=3,current=0,event=arc_off"];
    let line = |(step, told): (usize, &&str)| format!("{:.3},{told}", begin + step as f64 / 10.0);
    server.tell(&told.iter().enumerate().map(line).collect::<Vec<_>>());
    // Rows with the same values go on.
    wait_for("rows that go on", || log().rsplit("arc_off").next().is_some_and(|rest| rest.lines().count() > 4));
    ctrl_c(listener);
    let log = log();
    assert_eq!((log.matches("arc_on").count(), log.matches("arc_off").count()), (1, 1), "{log}");
    let rows: Vec<&str> =
        log[log.find('\n').unwrap() + 1..].lines().skip_while(|row| !row.contains("arc_on")).collect();
    assert!(rows.is_sorted() && rows.iter().all(|row| row.starts_with("2023-11-14T22:13:2")), "{log}");
}
