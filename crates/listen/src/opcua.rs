//! OPC UA: variables of a server.
//!
//! The server queues the values of the variables, and sends them with the times at which they changed. A row holds what all variables
//! are at its time, but words only when they are new. While nothing changes, the server says so twice a second, and a row goes on with
//! the same values. What the server sent while the connection was lost is asked for again; a session that it has forgotten is begun
//! anew, and so is a subscription that has gone silent.
//!
//! Rows have the times of the values. The server may send them by another clock: of that, only differences are used.

use crate::error::ListenError;
use crate::hearing::{Heard, Hearing};
use crate::payload;
use crate::watch::TICK;
use futures::{Stream, StreamExt, pin_mut};
use opcua_client::{
    Client, ClientBuilder, IdentityToken, MonitoredItemMap, OnSubscriptionNotificationCore, Password, Session,
    SessionConnectMode, SessionPollResult,
};
use opcua_types::{
    DataChangeNotification, DataValue, DateTime, EndpointDescription, MessageSecurityMode, MonitoredItemCreateRequest,
    MonitoringMode, MonitoringParameters, NodeId, NotificationMessage, ReadValueId, StatusCode, TimestampsToReturn,
    UserTokenPolicy, UserTokenType, Variant,
};
use serde_json::Value;
use std::collections::BTreeMap;
use std::str::FromStr;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::time::{interval, timeout};

/// How often the server sends what has changed.
const PUBLISHING: Duration = Duration::from_millis(100);
/// After this many reports without a change, it says that it is alive.
const ALIVE: u32 = 5;
/// It forgets us when it was not asked for this many reports: ten minutes.
const FORGOTTEN: u32 = 6000;
/// Values that it queues for each variable, if it can.
const QUEUE: u32 = 10_000;
/// Time within which it must answer.
const ANSWER: Duration = Duration::from_secs(10);
/// Longest time between attempts to connect again.
const AGAIN: Duration = Duration::from_secs(2);
/// A server that has sent nothing for this long has stopped sending.
const DEAF: Duration = Duration::from_secs(30);
/// A first value that is older makes no row of its own, µs: it may not have changed for days. A clock that goes back by more was set.
const OLD: i64 = 1_000_000;

/// What the reader hears from the connection.
enum Arrival {
    /// A message with values, of the subscription of this number.
    Values(usize, NotificationMessage),
    /// Something happened to the connection.
    Session(Result<SessionPollResult, StatusCode>),
}

/// Listens to variables of a server.
pub(crate) async fn listen(hearing: Hearing<'_>) -> Result<Heard, ListenError> {
    let nodes = nodes(&hearing)?;
    // The crate keeps certificates in a folder, also where none are used.
    let folder = tempfile::tempdir();
    let folder = folder.map_err(|why| hearing.refused(format!("no temporary folder can be made: {why}.")))?;
    let mut client = ClientBuilder::new()
        .application_name("Beadwright")
        .application_uri("urn:beadwright:listen")
        .pki_dir(folder.path())
        .session_name(format!("Beadwright {}", hearing.source.name))
        .session_retry_limit(-1)
        .session_retry_initial(Duration::from_millis(500))
        .session_retry_max(AGAIN)
        .session_timeout(PUBLISHING.as_millis() as u32 * FORGOTTEN)
        .keep_alive_interval(ANSWER / 2)
        .max_failed_keep_alive_count(2)
        .request_timeout(ANSWER)
        .min_publish_interval(PUBLISHING)
        .recreate_subscriptions(false)
        .max_array_length(100_000)
        .client()
        .map_err(|why| hearing.refused(why.join(" ")))?;
    let (endpoint, identity) = endpoint(&client, &hearing).await?;
    let opened = client.connect_to_endpoint_directly(endpoint, identity);
    let (session, events) = opened.map_err(|why| hearing.refused(format!("{why}.")))?;
    let (sender, incoming) = unbounded_channel();
    let pump = tokio::spawn(pump(events.enter(), sender.clone()));
    let values = nodes.iter().map(|_| None).collect();
    let rows = Rows { hearing, nodes, values, last: None, is_missing: false };
    let reader = Reader { rows, session, sender, heard: Instant::now(), number: 0, subscription: 0, next: 1 };
    let heard = reader.run(incoming).await;
    pump.abort();
    heard
}

/// Hands on what happens to the connection.
async fn pump(events: impl Stream<Item = Result<SessionPollResult, StatusCode>>, sender: UnboundedSender<Arrival>) {
    pin_mut!(events);
    while let Some(event) = events.next().await {
        let is_routine = matches!(event, Ok(SessionPollResult::Transport(_) | SessionPollResult::Subscription(_)));
        if !is_routine && sender.send(Arrival::Session(event)).is_err() {
            return;
        }
    }
    // The reader has ended if it does not want it.
    _ = sender.send(Arrival::Session(Err(StatusCode::BadConnectionClosed)));
}

/// The variables with their nodes.
fn nodes(hearing: &Hearing<'_>) -> Result<Vec<(String, NodeId)>, ListenError> {
    let node = |name: &str| {
        let node = NodeId::from_str(name);
        let node = node.map_err(|_| hearing.refused(format!("\"{name}\" is not a node such as ns=2;s=Power.Current.")));
        Ok((name.to_owned(), node?))
    };
    hearing.source.places().into_iter().map(node).collect()
}

/// The endpoint without encryption, and who we are.
async fn endpoint(client: &Client, hearing: &Hearing<'_>) -> Result<(EndpointDescription, IdentityToken), ListenError> {
    let url = hearing.source.url.as_str();
    let silent =
        || hearing.refused("the server does not answer. Check whether it runs, its address and the network.".into());
    let offered = timeout(ANSWER, client.get_server_endpoints_from_url(url)).await.map_err(|_| silent())?;
    let offered = offered.map_err(|_| silent())?;
    let mut plain =
        offered.into_iter().find(|endpoint| endpoint.security_mode == MessageSecurityMode::None).ok_or_else(|| {
            hearing.refused("it offers no endpoint with security policy None. Allow one for reading.".into())
        })?;
    // The server may know itself under another name than this network does.
    plain.endpoint_url = url.into();
    let (kind, identity) = match &hearing.source.user {
        Some((user, password)) => {
            (UserTokenType::UserName, IdentityToken::UserName(user.clone(), Password(password.clone())))
        }
        None => (UserTokenType::Anonymous, IdentityToken::Anonymous),
    };
    let allows = |policy: &UserTokenPolicy| policy.token_type == kind;
    if !plain.user_identity_tokens.as_deref().unwrap_or_default().iter().any(allows) {
        let reason = match hearing.source.user {
            Some(_) => "the server does not accept a user name and password. Leave out user.",
            None => "the server does not accept anonymous clients. Give user and password_file.",
        };
        return Err(hearing.refused(reason.into()));
    }
    Ok((plain, identity))
}

/// Hands on the messages of a subscription.
struct Notify {
    number: usize,
    sender: UnboundedSender<Arrival>,
}

impl OnSubscriptionNotificationCore for Notify {
    fn on_subscription_notification(&mut self, message: NotificationMessage, _: MonitoredItemMap<'_>) {
        // The reader has ended if it does not want it.
        _ = self.sender.send(Arrival::Values(self.number, message));
    }
}

struct Reader<'a> {
    rows: Rows<'a>,
    session: Arc<Session>,
    sender: UnboundedSender<Arrival>,
    /// When the server last said something of the subscription.
    heard: Instant,
    /// Subscriptions so far.
    number: usize,
    /// The server's name for the present one; 0 without one.
    subscription: u32,
    /// Number of the next message with values.
    next: u32,
}

impl Reader<'_> {
    async fn run(mut self, mut incoming: UnboundedReceiver<Arrival>) -> Result<Heard, ListenError> {
        if !timeout(ANSWER, self.session.wait_for_connection()).await.unwrap_or(false) {
            let reason = format!(
                "no session could be opened within {} s. Check user, password_file, and how many clients the server allows.",
                ANSWER.as_secs()
            );
            return Err(self.rows.hearing.refused(reason));
        }
        self.subscribe().await?;
        self.rows.hearing.begun();
        let mut tick = interval(TICK);
        loop {
            tokio::select! {
                event = incoming.recv() => match event {
                    Some(event) => self.take(event).await?,
                    None => return Err(ListenError::Ended),
                },
                _ = tick.tick() => {
                    if self.rows.hearing.tick()? {
                        break;
                    }
                    self.wake().await?;
                }
            }
        }
        _ = timeout(Duration::from_secs(2), self.session.disconnect()).await;
        self.rows.hearing.end()
    }

    /// Subscribes anew if the server has stopped sending.
    async fn wake(&mut self) -> Result<(), ListenError> {
        if self.rows.hearing.is_lost() || self.heard.elapsed() <= DEAF {
            return Ok(());
        }
        self.rows.hearing.interrupted("the server has stopped sending.")?;
        self.again(&SessionConnectMode::NewSession(NodeId::null())).await
    }

    /// Asks the server to send what changes.
    async fn subscribe(&mut self) -> Result<(), ListenError> {
        self.forget().await;
        self.number += 1;
        self.next = 1;
        self.heard = Instant::now();
        self.rows.values.fill(None);
        let hearing = &self.rows.hearing;
        let notify = Notify { number: self.number, sender: self.sender.clone() };
        let answer = self.session.create_subscription(PUBLISHING, FORGOTTEN, ALIVE, 0, 0, true, notify).await;
        self.subscription = answer.map_err(|why| hearing.refused(format!("{why}.")))?;
        let item = |(handle, (_, node)): (usize, &(String, NodeId))| MonitoredItemCreateRequest {
            item_to_monitor: ReadValueId::from(node.clone()),
            monitoring_mode: MonitoringMode::Reporting,
            requested_parameters: MonitoringParameters {
                client_handle: handle as u32 + 1,
                sampling_interval: hearing.source.sampling,
                queue_size: QUEUE,
                discard_oldest: true,
                ..Default::default()
            },
        };
        let items: Vec<_> = self.rows.nodes.iter().enumerate().map(item).collect();
        let answer = self.session.create_monitored_items(self.subscription, TimestampsToReturn::Both, items).await;
        let answers = answer.map_err(|why| hearing.refused(format!("{why}.")))?;
        for ((name, _), answer) in self.rows.nodes.iter().zip(&answers) {
            let code = answer.result.status_code;
            if !code.is_good() {
                let reason = format!("{name} cannot be read ({code}). Check the node in a browser such as UaExpert.");
                return Err(hearing.refused(reason));
            }
        }
        Ok(())
    }

    /// Deletes the present subscription, so that the server keeps nothing for it any longer.
    async fn forget(&mut self) {
        let subscription = std::mem::take(&mut self.subscription);
        if subscription != 0 {
            // A server that does not know it has nothing to delete.
            _ = self.session.delete_subscription(subscription).await;
        }
    }

    async fn take(&mut self, incoming: Arrival) -> Result<(), ListenError> {
        match incoming {
            Arrival::Values(number, message) if number == self.number => {
                self.heard = Instant::now();
                self.message(message).await
            }
            Arrival::Values(..) => Ok(()),
            Arrival::Session(Ok(SessionPollResult::Reconnected(mode))) => self.again(&mode).await,
            Arrival::Session(Ok(SessionPollResult::ConnectionLost(why) | SessionPollResult::ReconnectFailed(why))) => {
                self.rows.hearing.interrupted(&format!("{why}."))
            }
            Arrival::Session(Ok(_)) => Ok(()),
            Arrival::Session(Err(why)) => Err(self.rows.hearing.refused(format!("{why}."))),
        }
    }

    /// Goes on after the connection was made again.
    async fn again(&mut self, mode: &SessionConnectMode) -> Result<(), ListenError> {
        // The first connection.
        if !self.rows.hearing.is_lost() {
            return Ok(());
        }
        let kept = self.subscription != 0
            && match mode {
                SessionConnectMode::ReactivatedSession(_) => true,
                SessionConnectMode::NewSession(_) => self.transferred().await,
            };
        if kept {
            // Without being asked, the server sends nothing, and the crate asks only for subscriptions of this connection.
            self.session.trigger_publish_now();
            self.resumed("The server has kept what changed in the meantime.");
            return Ok(());
        }
        // A server that has just been started may not know all its variables yet; it is then asked again.
        match self.subscribe().await {
            Ok(()) => self.resumed("The server kept nothing, so what changed in the meantime is lost."),
            Err(why) => {
                self.rows.hearing.interrupted(&why.to_string())?;
                self.forget().await;
                self.number += 1;
                tokio::time::sleep(AGAIN).await;
                _ = self.sender.send(Arrival::Session(Ok(SessionPollResult::Reconnected(mode.clone()))));
            }
        }
        Ok(())
    }

    fn resumed(&mut self, kept: &str) {
        self.heard = Instant::now();
        self.rows.is_missing = false;
        self.rows.hearing.resumed(kept);
    }

    /// Whether the server lets a new session have the subscription of the old one.
    async fn transferred(&self) -> bool {
        let answer = self.session.transfer_subscriptions(&[self.subscription], false).await;
        answer.is_ok_and(|results| results.iter().all(|result| result.status_code.is_good()))
    }

    /// Takes a message after those that were lost before it, which the server keeps until they are acknowledged.
    async fn message(&mut self, message: NotificationMessage) -> Result<(), ListenError> {
        let lost = message.sequence_number.saturating_sub(self.next);
        if lost > QUEUE {
            self.rows.missing()?;
        }
        for number in (self.next..message.sequence_number).take(if lost > QUEUE { 0 } else { lost as usize }) {
            match self.session.republish(self.subscription, number).await {
                Ok(again) => self.rows.take(again)?,
                Err(_) => self.rows.missing()?,
            }
        }
        let has_values = message.notification_data.as_ref().is_some_and(|data| !data.is_empty());
        // One that only says that the server is alive has the number of the next.
        self.next = message.sequence_number.saturating_add(u32::from(has_values));
        self.rows.take(message)
    }
}

/// Makes rows of values.
struct Rows<'a> {
    hearing: Hearing<'a>,
    nodes: Vec<(String, NodeId)>,
    /// What each variable is; `None` if it is not known since we subscribed.
    values: Vec<Option<Value>>,
    /// Time of the last row, and when the server sent it by its own clock, µs since 1970.
    last: Option<[i64; 2]>,
    /// Whether it was said that values are missing, since the connection was last made.
    is_missing: bool,
}

impl Rows<'_> {
    /// Writes the rows of a message: one for each time at which something changed.
    fn take(&mut self, message: NotificationMessage) -> Result<(), ListenError> {
        let sent = micros(&message.publish_time);
        let now = self.last.map_or(sent, |[time, at]| time + (sent - at));
        let mut is_first: Vec<bool> = self.values.iter().map(Option::is_none).collect();
        let mut is_alive = true;
        let mut changes: BTreeMap<i64, Vec<(usize, DataValue)>> = BTreeMap::new();
        let data = message.notification_data.into_iter().flatten();
        let data = data.filter_map(|data| data.into_inner_as::<DataChangeNotification>());
        for item in data.flat_map(|data| data.monitored_items.into_iter().flatten()) {
            is_alive = false;
            let index = (item.client_handle as usize).wrapping_sub(1);
            let Some(first) = is_first.get_mut(index) else { continue };
            let stamp = item.value.source_timestamp.or(item.value.server_timestamp);
            let time = stamp.as_ref().map_or(now, micros);
            if std::mem::take(first) && self.is_old(time, now) {
                self.change(index, item.value)?;
            } else {
                changes.entry(time).or_default().push((index, item.value));
            }
        }
        for (time, values) in changes {
            let changed: Vec<usize> = values.iter().map(|(index, _)| *index).collect();
            for (index, value) in values {
                self.change(index, value)?;
            }
            self.row([time, sent], &changed)?;
        }
        if is_alive && self.last.is_none_or(|[last, _]| now > last) && self.values.iter().any(Option::is_some) {
            self.row([now, sent], &[])?;
        }
        Ok(())
    }

    /// Whether a first value was there before we listened.
    fn is_old(&self, time: i64, now: i64) -> bool {
        time < now - OLD || self.last.is_some_and(|[last, _]| time < last)
    }

    /// Takes a value of a variable.
    fn change(&mut self, index: usize, value: DataValue) -> Result<(), ListenError> {
        let name = &self.nodes[index].0;
        self.hearing.heard(name);
        self.values[index] = Some(Value::Null);
        let status = value.status.unwrap_or(StatusCode::Good);
        if !status.is_good() {
            return self.hearing.unreadable(name, &format!("the server says {status}."));
        }
        match plain(value.value) {
            Some(value) => self.values[index] = Some(value),
            None => self.hearing.unreadable(name, "it is neither a number nor a text.")?,
        }
        // The queue of the server was full.
        if status.overflow() { self.missing() } else { Ok(()) }
    }

    /// Says that some values cannot be had any more.
    fn missing(&mut self) -> Result<(), ListenError> {
        if std::mem::replace(&mut self.is_missing, true) {
            return Ok(());
        }
        self.hearing.missing("the server no longer had some values: rows are missing.")
    }

    /// Writes a row with the numbers that all variables are, and with the words that have changed. The server sent it by its own clock.
    fn row(&mut self, [time, sent]: [i64; 2], changed: &[usize]) -> Result<(), ListenError> {
        let mut cells = Vec::new();
        let mut faults = Vec::new();
        for column in &self.hearing.source.columns {
            let place = self.nodes.iter().position(|(name, _)| Some(name) == column.from.as_ref());
            let is_new = |place: &usize| !column.is_text() || changed.contains(place);
            let value = place.filter(is_new).and_then(|place| self.values[place].as_ref());
            let cell = value.map_or(Ok(None), |value| payload::cell(value, column));
            faults.extend(cell.as_ref().err().cloned().zip(column.from.clone()));
            cells.push(cell.ok().flatten().unwrap_or_default());
        }
        if let Some(text) = payload::micros(time) {
            self.hearing.row(&text, &cells)?;
            // A clock that was set back goes on from there.
            if self.last.is_none_or(|[last, _]| time >= last || time < last - OLD) {
                self.last = Some([time, sent]);
            }
        }
        faults.iter().try_for_each(|(reason, name)| self.hearing.unreadable(name, reason))
    }
}

/// Microseconds since 1970.
fn micros(time: &DateTime) -> i64 {
    time.as_chrono().timestamp_micros()
}

/// A number or a text.
fn plain(value: Option<Variant>) -> Option<Value> {
    Some(match value? {
        Variant::Boolean(on) => on.into(),
        Variant::SByte(number) => number.into(),
        Variant::Byte(number) => number.into(),
        Variant::Int16(number) => number.into(),
        Variant::UInt16(number) => number.into(),
        Variant::Int32(number) => number.into(),
        Variant::UInt32(number) => number.into(),
        Variant::Int64(number) => number.into(),
        Variant::UInt64(number) => number.into(),
        // Through text, so that 18.3 does not become 18.299999237060547.
        Variant::Float(number) => number.to_string().parse::<f64>().ok()?.into(),
        Variant::Double(number) => number.into(),
        Variant::String(text) => text.as_ref().into(),
        Variant::LocalizedText(text) => text.text.as_ref().into(),
        Variant::DateTime(time) => time.to_rfc3339().into(),
        _ => return None,
    })
}
