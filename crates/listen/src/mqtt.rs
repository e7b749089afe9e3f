//! MQTT: topics of a broker.
//!
//! The session is one that the broker keeps under our name, with quality of service 1: what is published while the connection is lost
//! comes afterwards. A message is acknowledged once its row is written; what the broker then sends twice is written once.

use crate::error::ListenError;
use crate::hearing::{Heard, Hearing};
use crate::payload;
use crate::source::{Column, Source};
use crate::watch::TICK;
use rumqttc::{
    AsyncClient, ConnectionError, Event, EventLoop, Incoming, MqttOptions, Publish, QoS, SubscribeFilter,
    SubscribeReasonCode,
};
use std::collections::VecDeque;
use std::time::Duration;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::time::{Instant, interval, sleep, timeout_at};

/// A broker that says nothing for twice this time is taken for lost.
const ALIVE: Duration = Duration::from_secs(5);
/// Time between attempts to connect again.
const AGAIN: Duration = Duration::from_millis(500);
/// Time within which a connection must be made to begin with.
const FIRST: Duration = Duration::from_secs(10);
/// Longest message, bytes.
const LONGEST: usize = 1 << 20;
/// Acknowledgements that may wait to be sent.
const WAITING: usize = 1 << 14;
/// Messages that are remembered, to know those that are sent again.
const REMEMBERED: usize = 1000;

type Arrival = Result<Event, ConnectionError>;

/// Listens to the topics of a broker.
pub(crate) async fn listen((host, port): (&str, u16), hearing: Hearing<'_>) -> Result<Heard, ListenError> {
    let source = hearing.source;
    let mut options = MqttOptions::new(&source.client, host, port);
    options.set_clean_session(false).set_manual_acks(true).set_keep_alive(ALIVE);
    options.set_max_packet_size(LONGEST, LONGEST);
    if let Some((user, password)) = &source.user {
        options.set_credentials(user, password);
    }
    let (client, events) = AsyncClient::new(options, WAITING);
    let (sender, incoming) = unbounded_channel();
    let pump = tokio::spawn(pump(events, sender));
    let heard = Reader { client, hearing, seen: VecDeque::new() }.run(incoming).await;
    pump.abort();
    heard
}

/// Hands on what happens on the connection, which is made again whenever it is lost.
async fn pump(mut events: EventLoop, sender: UnboundedSender<Arrival>) {
    loop {
        let event = events.poll().await;
        let is_lost = event.is_err();
        if sender.send(event).is_err() {
            return;
        }
        if is_lost {
            sleep(AGAIN).await;
        }
    }
}

struct Reader<'a> {
    client: AsyncClient,
    hearing: Hearing<'a>,
    /// Packet and content of the last messages.
    seen: VecDeque<(u16, Publish)>,
}

impl Reader<'_> {
    async fn run(mut self, mut incoming: UnboundedReceiver<Arrival>) -> Result<Heard, ListenError> {
        self.begin(&mut incoming).await?;
        self.hearing.begun();
        let mut tick = interval(TICK);
        loop {
            tokio::select! {
                event = incoming.recv() => match event {
                    Some(event) => self.take(event)?,
                    None => return Err(ListenError::Ended),
                },
                _ = tick.tick() => {
                    self.hearing.report_silence()?;
                    if self.hearing.tick()? {
                        break;
                    }
                }
            }
        }
        // Who must begin again because of another source wants what is published until then.
        if !self.hearing.is_failed() {
            self.leave(&mut incoming).await?;
        }
        self.hearing.end()
    }

    /// Connects and subscribes.
    async fn begin(&mut self, incoming: &mut UnboundedReceiver<Arrival>) -> Result<(), ListenError> {
        let until = Instant::now() + FIRST;
        let silent = |own: &Self| {
            own.hearing.refused(format!("it did not answer within {} s. Check address and network.", FIRST.as_secs()))
        };
        loop {
            let event =
                timeout_at(until, incoming.recv()).await.map_err(|_| silent(self))?.ok_or(ListenError::Ended)?;
            match event {
                Ok(Event::Incoming(Incoming::ConnAck(_))) => self.subscribe()?,
                Ok(Event::Incoming(Incoming::SubAck(answer))) => return self.allowed(&answer.return_codes),
                // What the broker has kept for us since we last listened.
                Ok(event) => self.take(Ok(event))?,
                Err(why) => return Err(self.hearing.refused(sentence(&why))),
            }
        }
    }

    fn subscribe(&self) -> Result<(), ListenError> {
        let wanted = self.hearing.source.places().into_iter();
        let filters = wanted.map(|topic| SubscribeFilter::new(topic.to_owned(), QoS::AtLeastOnce));
        self.client.try_subscribe_many(filters).map_err(|why| self.hearing.refused(why.to_string()))
    }

    fn allowed(&self, codes: &[SubscribeReasonCode]) -> Result<(), ListenError> {
        let topics = self.hearing.source.places();
        let refused = topics.iter().zip(codes).find(|(_, code)| **code == SubscribeReasonCode::Failure);
        refused.map_or(Ok(()), |(topic, _)| {
            Err(self
                .hearing
                .refused(format!("the broker denies read access to {topic}. Ask its administrator for it.")))
        })
    }

    fn take(&mut self, event: Arrival) -> Result<(), ListenError> {
        match event {
            Ok(Event::Incoming(Incoming::Publish(message))) => self.publish(message),
            Ok(Event::Incoming(Incoming::ConnAck(answer))) => {
                let kept = if answer.session_present {
                    "The broker has kept what was published in the meantime."
                } else {
                    self.subscribe()?;
                    "The broker kept nothing, so what was published in the meantime is lost. Turn on its persistence."
                };
                self.hearing.resumed(kept);
                Ok(())
            }
            Ok(_) => Ok(()),
            Err(why) => self.hearing.interrupted(&sentence(&why)),
        }
    }

    /// Writes the row of a message, then acknowledges it.
    fn publish(&mut self, message: Publish) -> Result<(), ListenError> {
        // What is retained was kept for new listeners: nobody knows how old it is. A topic may be left from an earlier file.
        let is_ours = self.hearing.source.places().contains(&message.topic.as_str());
        let is_wanted = is_ours && !message.retain && !self.is_known(&message);
        if is_wanted {
            self.hearing.heard(&message.topic);
            match row(self.hearing.source, &message) {
                // Acknowledged too late when listening had ended.
                Ok((time, cells)) if message.dup && self.hearing.has(&time, &cells) => {}
                Ok((time, cells)) => self.hearing.row(&time, &cells)?,
                Err(reason) => self.hearing.unreadable(&message.topic, &reason)?,
            }
        }
        // Where this fails, the connection is lost, and the broker sends the message again.
        _ = self.client.try_ack(&message);
        if is_wanted {
            self.seen.truncate(REMEMBERED - 1);
            self.seen.push_front((message.pkid, message));
        }
        Ok(())
    }

    /// Whether the broker has sent this message already.
    fn is_known(&self, message: &Publish) -> bool {
        let same = |own: &Publish| own.topic == message.topic && own.payload == message.payload;
        message.dup && self.seen.iter().any(|(packet, own)| *packet == message.pkid && same(own))
    }

    /// Tells the broker to keep nothing for us any longer, so that the next log does not begin with the end of this one.
    async fn leave(&mut self, incoming: &mut UnboundedReceiver<Arrival>) -> Result<(), ListenError> {
        // What has come already is acknowledged before the connection ends.
        while let Ok(event) = incoming.try_recv() {
            self.take(event)?;
        }
        for topic in self.hearing.source.places() {
            _ = self.client.try_unsubscribe(topic);
        }
        _ = self.client.try_disconnect();
        let until = Instant::now() + Duration::from_secs(1);
        // The connection ends with an error once all is sent.
        while let Ok(Some(Ok(event))) = timeout_at(until, incoming.recv()).await {
            self.take(Ok(event))?;
        }
        Ok(())
    }
}

/// The row of a message: its time, and its cells.
fn row(source: &Source, message: &Publish) -> Result<(String, Vec<String>), String> {
    let parsed = payload::parsed(&message.payload);
    let time = source.time.as_ref().map_or_else(|| Ok(payload::now()), |time| payload::time(&parsed, time))?;
    let own = |column: &Column| column.from.as_deref() == Some(message.topic.as_str());
    let cell = |column| if own(column) { payload::cell(&parsed, column) } else { Ok(None) };
    let cells = source.columns.iter().map(cell).collect::<Result<Vec<_>, _>>()?;
    if cells.iter().all(Option::is_none) {
        let fields = source.columns.iter().filter(|column| own(column)).filter_map(|column| column.field.as_deref());
        return Err(format!("it has no field {}: {}", fields.collect::<Vec<_>>().join(", "), payload::short(&parsed)));
    }
    Ok((time, cells.into_iter().map(Option::unwrap_or_default).collect()))
}

/// Why a connection cannot be made or was lost, and what to do.
fn sentence(why: &ConnectionError) -> String {
    match why {
        ConnectionError::Io(why) => format!("{why}. Check whether the broker runs, its address and the network."),
        ConnectionError::ConnectionRefused(code) => {
            format!("the broker refuses us ({code:?}). Check user and password_file.")
        }
        why => format!("{why}."),
    }
}
