//! What a connection waits for, as told by those who read, answer and write on it.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::limits::Limits;
use crate::http::pace::Pace;

/// How long a client is waited for, even if others want its place: an honest one sends its request at once.
const PATIENCE_FOR_HEADS: Duration = Duration::from_secs(1);

/// The same for 64 KiB of a body or an answer, where a poor line may pause.
const PATIENCE_WITHIN: Duration = Duration::from_secs(5);

/// What one connection waits for, and since when.
#[derive(Debug)]
pub(super) struct Activity(Mutex<State>);

#[derive(Debug)]
struct State {
    phase: Phase,
    /// Begin of the phase or, of a rest, the last piece of the answer before it that the system took.
    since: Instant,
    /// Since when the system takes nothing more of what is written, because the client reads nothing.
    blocked: Option<Instant>,
    /// Of the body of this request.
    body: Pace,
    /// Of what is written.
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
    /// An answer is under way that lasts as long as there is something to tell.
    Lasting,
}

/// Why a connection is closed though its client might want it open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Overdue {
    /// The head of a request takes too long.
    Head,
    /// It rests for too long.
    Rest,
    /// The client does not take its answer.
    Answer,
}

/// How readily a connection is given up for another, the most readily last.
pub(super) type Dispensability = (Loss, Duration);

/// What its client loses with a connection, the least last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Loss {
    /// An answer that tells it of changes as they come, for which it can ask again.
    Lasting,
    /// A request or an answer that does not move.
    Stalled,
    /// Nothing.
    Rest,
}

impl Activity {
    /// Of a new connection.
    pub(super) fn new() -> Self {
        Self(Mutex::new(State {
            phase: Phase::Head,
            since: Instant::now(),
            blocked: None,
            body: Pace::default(),
            answer: Pace::default(),
        }))
    }

    /// Something has come.
    pub(super) fn read(&self) {
        let mut state = self.lock();
        if state.phase == Phase::Rest {
            state.enter(Phase::Head);
        }
    }

    /// The head of a request is complete.
    pub(super) fn request(&self) {
        let mut state = self.lock();
        state.enter(Phase::Work);
        (state.body, state.answer) = (Pace::default(), Pace::default());
    }

    /// More of the body is needed and has not come.
    pub(super) fn body_expected(&self) {
        let mut state = self.lock();
        if state.phase != Phase::Body {
            state.enter(Phase::Body);
        }
    }

    /// So many bytes more of the body are there.
    pub(super) fn body_came(&self, bytes: u64) {
        let mut state = self.lock();
        let waited = if state.phase == Phase::Body { state.since.elapsed() } else { Duration::ZERO };
        state.body.moves(bytes, waited);
        state.enter(Phase::Work);
    }

    /// The answer has begun and lasts as long as there is something to tell.
    pub(super) fn lasts(&self) {
        self.lock().enter(Phase::Lasting);
    }

    /// The answer is complete, though the system may not have taken all of it.
    pub(super) fn answered(&self) {
        self.lock().enter(Phase::Rest);
    }

    /// The system takes no more of the answer until the client reads.
    pub(super) fn blocked(&self) {
        self.lock().blocked.get_or_insert_with(Instant::now);
    }

    /// The system took so many bytes.
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

    /// Which limit it has passed, if any. Bodies are looked after where they are read, so that their requests are answered.
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

    /// How readily it is given up for another; `None` as long as its client does nothing unusual. Those at rest go first, then
    /// the one that has waited longest, and of answers that last the one that began first.
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
    /// For how long the client has kept the service waiting: since the phase began, or for this piece of a body or an answer.
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
