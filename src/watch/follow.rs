//! The thread that decides: what has changed, what has to run, what is told.

use super::lane::Lane;
use super::listening::{Listening, POLL};
use super::mailbox::Inbox;
use super::run::{Ended, Outcome, Run, Switches};
use super::session::{Running, Session, State};
use super::{Told, Watch};
use crate::world::{Doubt, NoticesError};
use std::collections::BTreeSet;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long a run may take to end when the watch does.
const FAREWELL: Duration = Duration::from_millis(300);

/// How long nothing new may be seen while changes come faster than pictures.
const UNSEEN: Duration = Duration::from_millis(500);

/// Everything that the thread knows.
pub(super) struct Follow {
    watch: Watch,
    sessions: Vec<Session>,
    lane: Lane,
    listening: Listening,
    runs: u64,
}

impl Follow {
    /// # Errors
    /// If the system gives no thread.
    pub(super) fn new(watch: Watch) -> io::Result<Follow> {
        let now = Instant::now();
        let session = |followed: &Arc<_>| Session::new(Arc::clone(followed), now);
        Ok(Follow {
            sessions: watch.followed.iter().map(session).collect(),
            lane: Lane::new(watch.engine.clone())?,
            listening: Listening::new(watch.options.poll),
            runs: 0,
            watch,
        })
    }

    pub(super) fn run(mut self) {
        self.listen();
        self.follow_paths(&mut Inbox::default());
        loop {
            self.start_next();
            let inbox = self.watch.mailbox.take(self.wakes_at());
            if inbox.stop {
                return self.stop();
            }
            self.attend(inbox);
        }
    }

    fn attend(&mut self, mut inbox: Inbox) {
        for ended in std::mem::take(&mut inbox.ended) {
            self.conclude(ended);
        }
        if !inbox.reads.is_empty() || inbox.heard() {
            self.follow_paths(&mut inbox);
        }
        if !inbox.reads.is_empty() {
            // A notice may have come before the run knew what it had read.
            self.find_changes(Doubt::Lately(&inbox.reads));
        }
        if inbox.heard() {
            self.listening.hear(&inbox);
            self.look(&inbox);
        }
        if Instant::now() >= self.listening.looks_at() {
            self.look_around();
        }
        self.tell_failures();
    }

    /// When there is something to do even if nothing is heard.
    fn wakes_at(&self) -> Instant {
        let is_due = |session: &Session| matches!(session.state, State::Due);
        let waits = !self.is_busy() && self.sessions.iter().any(is_due);
        let start = waits.then(|| self.lane.frees_at()).flatten();
        let told = self.sessions.iter().filter_map(Session::tells_at);
        let look = self.listening.looks_at();
        told.chain(start).fold(look, Instant::min)
    }

    /// Asks for notices; without them files are looked at again and again.
    fn listen(&mut self) {
        let watch = &self.watch;
        if watch.options.poll.is_none()
            && let Err(error) = self.listening.start(&*watch.world, &watch.mailbox)
        {
            self.poll(&error);
        }
    }

    /// Does without notices, and says so.
    fn poll(&mut self, error: &NoticesError) {
        self.listening.poll();
        for session in &self.sessions {
            let told = Told::Polling {
                reason: error.to_string(),
                milliseconds: POLL.as_millis() as u64,
            };
            (self.watch.audience)(&session.followed.recipe, told);
        }
    }

    fn paths(&self) -> BTreeSet<PathBuf> {
        self.sessions.iter().flat_map(Session::paths).collect()
    }

    /// Has the notices follow all paths, and adds to the inbox where something may have been missed.
    fn follow_paths(&mut self, inbox: &mut Inbox) {
        if let Err(error) = self.listening.follow(self.paths(), inbox) {
            inbox.all = true;
            self.poll(&error);
        }
    }

    /// Looks at what was heard of.
    fn look(&mut self, inbox: &Inbox) -> Option<PathBuf> {
        let now = Instant::now();
        for session in &mut self.sessions {
            if inbox.all || session.reads_any(&inbox.paths) {
                session.stirred = now;
            }
        }
        let doubt = if inbox.all {
            Doubt::All
        } else {
            Doubt::About(&inbox.paths)
        };
        self.find_changes(doubt)
    }

    /// Looks at the stamps of everything.
    fn look_around(&mut self) {
        let all = self.listening.begin_look(self.paths());
        let all = all.unwrap_or_else(|error| {
            self.poll(&error);
            true
        });
        let found = self.look(&Inbox {
            all,
            ..Inbox::default()
        });
        if let Err(error) = self.listening.end_look(found) {
            self.poll(&error);
        }
    }

    /// Makes what has changed due, and stops what it is out of date for; gives a path that changed.
    fn find_changes(&mut self, doubt: Doubt<'_>) -> Option<PathBuf> {
        let (world, now) = (Arc::clone(&self.watch.world), Instant::now());
        let mut found = None;
        for index in 0..self.sessions.len() {
            if matches!(self.sessions[index].state, State::Due) {
                continue;
            }
            if let Some(path) = self.sessions[index].changed_path(&*world, doubt) {
                found = Some(path);
                self.supersede(index, now);
            }
        }
        found
    }

    /// The recipe has changed: it runs next, and whatever runs now makes way for it.
    fn supersede(&mut self, index: usize, now: Instant) {
        for other in 0..self.sessions.len() {
            let session = &mut self.sessions[other];
            let is_unseen = session.shown.is_none_or(|shown| now > shown + UNSEEN);
            if let State::Running(running) = &session.state {
                self.lane.stop(running, other == index && is_unseen, now);
                session.state = State::Due;
            }
        }
        let session = &mut self.sessions[index];
        (session.changed, session.stirred) = (now, now);
        session.state = State::Due;
    }

    fn is_busy(&self) -> bool {
        self.sessions.iter().any(Session::is_running)
    }

    /// Starts the recipe that changed last, if nothing else runs.
    fn start_next(&mut self) {
        if self.is_busy() {
            return;
        }
        let due = self.sessions.iter().enumerate().rev();
        let due = due.filter(|(_, session)| matches!(session.state, State::Due));
        // Of those that changed at the same time the first: all of them, at the start.
        let next = due.max_by_key(|(_, session)| session.changed);
        if let Some((index, _)) = next
            && self.lane.is_free(Instant::now())
        {
            self.start(index);
        }
    }

    fn start(&mut self, index: usize) {
        self.runs += 1;
        let (watch, session) = (&self.watch, &mut self.sessions[index]);
        let switches = Switches::default();
        let running = Running {
            number: self.runs,
            switches: switches.clone(),
        };
        self.lane.start(Run {
            number: self.runs,
            followed: Arc::clone(&session.followed),
            engine: self.lane.engine(),
            world: Arc::clone(&watch.world),
            audience: Arc::clone(&watch.audience),
            mailbox: Arc::clone(&watch.mailbox),
            trace: session.begin(running),
            switches,
            preview: watch.options.preview,
            noticed: session.changed,
        });
    }

    fn conclude(&mut self, ended: Ended) {
        let now = Instant::now();
        self.lane.end(ended.number, now);
        let Some(session) = self
            .sessions
            .iter_mut()
            .find(|it| it.newest == ended.number)
        else {
            return;
        };
        if ended.shown {
            session.shown = Some(now);
        }
        if !session.is_running() {
            // Overtaken by a change.
            return;
        }
        match ended.outcome {
            Outcome::Rendered(rendered) => {
                session.end(State::Settled);
                (self.watch.audience)(&session.followed.recipe, Told::Rendered(rendered));
            }
            Outcome::Failed(failed) => session.end(State::Failing(failed)),
            Outcome::Stopped => session.state = State::Due,
        }
    }

    /// Tells of mistakes in files that have been quiet, if they are still the same.
    fn tell_failures(&mut self) {
        let now = Instant::now();
        let is_ready = |session: &Session| session.tells_at().is_some_and(|time| time <= now);
        if !self.sessions.iter().any(is_ready) {
            return;
        }
        // Where notices do not come the last look may be long ago.
        self.find_changes(Doubt::About(&BTreeSet::new()));
        for session in &mut self.sessions {
            for told in session.failed(now).into_iter().flatten() {
                (self.watch.audience)(&session.followed.recipe, told);
            }
        }
    }

    /// Stops what runs, and waits a moment for it to leave everything in order.
    fn stop(self) {
        let end = Instant::now() + FAREWELL;
        let mut going = self.lane.stopping();
        for session in &self.sessions {
            if let State::Running(running) = &session.state {
                running.switches.stop();
                going = Some(running.number);
            }
        }
        while going.is_some() && Instant::now() < end {
            let ended = self.watch.mailbox.take(end).ended;
            going = going.filter(|number| ended.iter().all(|it| it.number != *number));
        }
    }
}
