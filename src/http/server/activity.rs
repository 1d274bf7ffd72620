//! Activity of a connection: what it waits for, as reported by those who read, answer and write on it.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::limits::Limits;
use crate::http::pace::Pace;

/// Wait for the head of a request before others may take the connection's place: an honest client sends its request at once.
const PATIENCE_FOR_HEADS: Duration = Duration::from_secs(1);

/// Wait for the next 64 KiB of a body or an answer before others may take the connection's place: a poor line may pause.
const PATIENCE_WITHIN: Duration = Duration::from_secs(5);

/// Activity of one connection: what it waits for, and since when.
#[derive(Debug)]
pub(super) struct Activity(Mutex<State>);

#[derive(Debug)]
struct State {
    phase: Phase,
    /// Begin of the phase or, for a rest, the time at which the system took the last piece of the answer before it.
    since: Instant,
    /// Time since which the system takes no more of the answer, because the client reads nothing.
    blocked: Option<Instant>,
    /// Pace of the body of this request.
    body: Pace,
    /// Pace of the answers that are written.
    answer: Pace,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// Nothing of the next request has come.
    Rest,
    /// The head of a request is expected: some of it has come, or the connection is new.
    Head,
    /// The next piece of a body is expected.
    Body,
    /// The next step is the service's.
    Work,
    /// An answer is under way that lasts as long as there are changes to report.
    Lasting,
}

/// Reason why a connection is closed though its client might want it open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Overdue {
    /// The head of a request takes too long.
    Head,
    /// The connection rests for too long.
    Rest,
    /// The client does not take its answer.
    Answer,
}

/// Rank of a connection when one is given up for another; the highest rank goes first.
pub(super) type Dispensability = (Loss, Duration);

/// Loss of a client whose connection is given up, the least last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Loss {
    /// An answer that reports changes as they come, for which the client can ask again.
    Lasting,
    /// A request or an answer that does not move.
    Stalled,
    /// Nothing: no request is under way.
    Rest,
}

impl Activity {
    /// Starts with the head of a request, which a new connection expects.
    pub(super) fn new() -> Self {
        Self(Mutex::new(State {
            phase: Phase::Head,
            since: Instant::now(),
            blocked: None,
            body: Pace::default(),
            answer: Pace::default(),
        }))
    }

    /// Notes that bytes of a request have come.
    pub(super) fn read(&self) {
        let mut state = self.lock();
        if state.phase == Phase::Rest {
            state.enter(Phase::Head);
        }
    }

    /// Notes that the head of a request is complete.
    pub(super) fn request(&self) {
        let mut state = self.lock();
        state.enter(Phase::Work);
        (state.body, state.answer) = (Pace::default(), Pace::default());
    }

    /// Notes that more of the body is needed and has not come.
    pub(super) fn body_expected(&self) {
        let mut state = self.lock();
        if state.phase != Phase::Body {
            state.enter(Phase::Body);
        }
    }

    /// Notes that `bytes` more of the body are there.
    pub(super) fn body_came(&self, bytes: u64) {
        let mut state = self.lock();
        let waited = if state.phase == Phase::Body { state.since.elapsed() } else { Duration::ZERO };
        state.body.moves(bytes, waited);
        state.enter(Phase::Work);
    }

    /// Notes that the answer has begun and lasts as long as there are changes to report.
    pub(super) fn lasts(&self) {
        self.lock().enter(Phase::Lasting);
    }

    /// Notes that the answer is complete, though the system may not have taken all of it.
    pub(super) fn answered(&self) {
        self.lock().enter(Phase::Rest);
    }

    /// Notes that the system takes no more of the answer until the client reads.
    pub(super) fn blocked(&self) {
        self.lock().blocked.get_or_insert_with(Instant::now);
    }

    /// Notes that the system took `bytes` more of the answer.
    pub(super) fn written(&self, bytes: u64) {
        let mut state = self.lock();
        let waited = state.blocked.take().map_or(Duration::ZERO, |since| since.elapsed());
        state.answer.moves(bytes, waited);
        if state.phase == Phase::Rest {
            state.since = Instant::now();
        }
    }

    /// Whether nothing would be lost with the connection.
    pub(super) fn is_free(&self) -> bool {
        let state = self.lock();
        matches!(state.phase, Phase::Rest | Phase::Head) && state.blocked.is_none()
    }

    /// Limit that the connection has passed, if any. Bodies are checked where they are read, so that their requests are answered.
    pub(super) fn overdue(&self, now: Instant, limits: &Limits) -> Option<Overdue> {
        let state = self.lock();
        let waited = state.waited(now);
        match (state.blocked, state.phase) {
            (Some(_), _) => (waited > limits.stall).then_some(Overdue::Answer),
            (None, Phase::Head) => (waited > limits.head).then_some(Overdue::Head),
            (None, Phase::Rest) => (waited > limits.idle).then_some(Overdue::Rest),
            (None, Phase::Body | Phase::Work | Phase::Lasting) => None,
        }
    }

    /// Rank of the connection when one is given up for another; `None` as long as its client does nothing unusual. Connections at
    /// rest go first, then the one that has waited longest, and of answers that last the one that began first.
    pub(super) fn dispensability(&self, now: Instant) -> Option<Dispensability> {
        let state = self.lock();
        let (loss, patience) = match (state.blocked, state.phase) {
            (Some(_), _) | (None, Phase::Body) => (Loss::Stalled, PATIENCE_WITHIN),
            (None, Phase::Head) => (Loss::Stalled, PATIENCE_FOR_HEADS),
            (None, Phase::Rest) => (Loss::Rest, PATIENCE_FOR_HEADS),
            (None, Phase::Lasting) => (Loss::Lasting, PATIENCE_WITHIN),
            (None, Phase::Work) => return None,
        };
        let waited = state.waited(now);
        (waited > patience).then_some((loss, waited))
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Time for which the client has kept the service waiting: since the phase began, or for this piece of a body or an answer.
    fn waited(&self, now: Instant) -> Duration {
        match (self.blocked, self.phase) {
            (Some(blocked), _) => self.answer.waited() + now.saturating_duration_since(blocked),
            (None, Phase::Body) => self.body.waited() + now.saturating_duration_since(self.since),
            (None, _) => now.saturating_duration_since(self.since),
        }
    }

    fn enter(&mut self, phase: Phase) {
        (self.phase, self.since) = (phase, Instant::now());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::http::pace::PIECE;

    const LIMITS: Limits = Limits {
        connections: 1,
        head: Duration::from_secs(10),
        idle: Duration::from_secs(30),
        stall: Duration::from_secs(20),
    };

    fn after(seconds: u64) -> Instant {
        Instant::now() + Duration::from_secs(seconds)
    }

    #[test]
    fn each_phase_has_its_limit() {
        let activity = Activity::new();
        assert_eq!(activity.overdue(after(9), &LIMITS), None);
        assert_eq!(activity.overdue(after(11), &LIMITS), Some(Overdue::Head), "nothing came at all");
        activity.request();
        assert_eq!(activity.overdue(after(1000), &LIMITS), None, "the service may take its time");
        activity.body_expected();
        assert_eq!(activity.overdue(after(1000), &LIMITS), None, "bodies are looked after elsewhere");
        activity.body_came(1);
        activity.answered();
        assert_eq!(activity.overdue(after(29), &LIMITS), None);
        assert_eq!(activity.overdue(after(31), &LIMITS), Some(Overdue::Rest));
        activity.read();
        assert_eq!(activity.overdue(after(11), &LIMITS), Some(Overdue::Head), "a begun head has less time");
    }

    #[test]
    fn an_answer_that_is_not_taken_counts_whatever_the_phase() {
        let activity = Activity::new();
        activity.request();
        activity.blocked();
        assert_eq!(activity.overdue(after(19), &LIMITS), None);
        assert_eq!(activity.overdue(after(21), &LIMITS), Some(Overdue::Answer));
        activity.answered();
        assert_eq!(activity.overdue(after(21), &LIMITS), Some(Overdue::Answer));
        assert!(!activity.is_free());
        activity.written(1);
        assert_eq!(activity.overdue(after(21), &LIMITS), None);
        assert!(activity.is_free());
    }

    #[test]
    fn room_is_made_by_those_at_rest_first_and_never_by_those_that_work() {
        let (resting, sending, working) = (Activity::new(), Activity::new(), Activity::new());
        let new = Activity::new();
        resting.answered();
        working.request();
        sending.request();
        sending.body_expected();
        assert_eq!(new.dispensability(Instant::now()), None, "it has just come");
        assert!(resting.dispensability(after(2)) > new.dispensability(after(9)));
        assert!(new.dispensability(after(2)).is_some());
        assert_eq!(sending.dispensability(after(2)), None);
        assert!(sending.dispensability(after(6)).is_some());
        assert_eq!(working.dispensability(after(1000)), None);
    }

    #[test]
    fn answers_that_last_are_given_up_last() {
        let (sending, following) = (Activity::new(), Activity::new());
        for activity in [&sending, &following] {
            activity.request();
        }
        sending.body_expected();
        following.lasts();
        assert_eq!(
            following.overdue(after(100_000), &LIMITS),
            None,
            "whoever follows a job may do so for days"
        );
        assert_eq!(following.dispensability(after(2)), None);
        assert!(following.dispensability(after(1000)).is_some());
        assert!(following.dispensability(after(1000)) < sending.dispensability(after(6)));
    }

    #[test]
    fn a_trickle_is_as_lazy_as_silence() {
        let (trickling, sending) = (Activity::new(), Activity::new());
        for activity in [&trickling, &sending] {
            activity.request();
            activity.body_expected();
            let mut state = activity.lock();
            state.since = Instant::now().checked_sub(Duration::from_secs(4)).unwrap();
        }
        trickling.body_came(1);
        sending.body_came(PIECE);
        trickling.body_expected();
        sending.body_expected();
        assert!(trickling.dispensability(after(2)).is_some());
        assert_eq!(sending.dispensability(after(2)), None);
    }
}
