//! Progress of a job as one number and a few words, and cancellation, as the computations see them.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use super::time_left::Pace;
use crate::analysis::monitor::Monitor;
use crate::analysis::result::CostRange;
use crate::store::Changes;
use crate::store::jobs::JobId;

/// Percent of a sweep that its reduction counts for.
const REDUCTION_OF_SWEEP: f64 = 10.0;
/// Percent of a modal analysis that its reduction counts for: nearly all the work.
const REDUCTION_OF_ONCE: f64 = 90.0;

/// Progress of a job.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Report {
    pub(super) percent: u8,
    pub(super) phase: String,
}

/// Latest report on each job, until it is taken to the store.
#[derive(Debug, Default)]
pub(super) struct PendingReports {
    changes: Changes,
    latest: Mutex<HashMap<JobId, Report>>,
}

impl PendingReports {
    /// Reports that are also announced to `changes`.
    pub(super) fn new(changes: Changes) -> Self {
        Self { changes, latest: Mutex::default() }
    }

    /// Takes the reports that are new.
    pub(super) fn take(&self) -> HashMap<JobId, Report> {
        std::mem::take(&mut *self.latest.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Puts back a report that could not be stored, unless there is a newer one.
    pub(super) fn put_back(&self, job: JobId, report: Report) {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner).entry(job).or_insert(report);
    }

    fn put(&self, job: JobId, report: Report) {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner).insert(job, report);
        self.changes.tell(job);
    }
}

/// Watch over all computations of one job: their progress and their cancellation.
#[derive(Debug)]
pub(super) struct Watch {
    job: JobId,
    dismissed: AtomicBool,
    /// Whether a warning has been logged that linear theory was left.
    warned: AtomicBool,
    stopping: Arc<AtomicBool>,
    done: Mutex<Done>,
    reports: Arc<PendingReports>,
}

/// Progress within a job.
#[derive(Debug, Default)]
struct Done {
    /// Percentage of the job that is done.
    percent: u8,
    /// Description of what is being done.
    phase: String,
    /// Number of results that cannot be stored yet, and what the last of them waits for.
    waiting: (u32, &'static str),
    /// Percentage and phase reported last.
    reported: (u8, String),
    speeds: u32,
    finished: u32,
    /// Number of speeds that were asked for, once it is known: others are added around peaks.
    asked: Option<u32>,
    /// Phases that follow the speeds asked for, and those that follow the added speeds, in words.
    follows: [String; 2],
    /// Finished fraction of each speed that is being computed.
    running: HashMap<u32, f64>,
    pace: Pace,
}

impl Watch {
    pub(super) fn new(
        job: JobId,
        speeds: u32,
        stopping: Arc<AtomicBool>,
        reports: Arc<PendingReports>,
    ) -> Arc<Self> {
        let done = Mutex::new(Done { speeds, ..Done::default() });
        let (dismissed, warned) = (AtomicBool::new(false), AtomicBool::new(false));
        Arc::new(Self { job, dismissed, warned, stopping, done, reports })
    }

    /// Whether this is the first time that a speed of the job is seen to leave linear theory, since the service began it.
    pub(super) fn first_to_warn(&self) -> bool {
        !self.warned.swap(true, Ordering::Relaxed)
    }

    /// Id of the watched job.
    pub(super) fn job(&self) -> JobId {
        self.job
    }

    /// Latest phase of the job; `None` before the first.
    pub(super) fn phase(&self) -> Option<String> {
        let done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        Some(done.words().to_owned()).filter(|phase| !phase.is_empty())
    }

    /// Tells all computations of the job to stop.
    pub(super) fn dismiss(&self) {
        self.dismissed.store(true, Ordering::Relaxed);
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.dismissed.load(Ordering::Relaxed) || self.stopping.load(Ordering::Relaxed)
    }

    /// Marks a result as waiting for `what` until the guard is dropped; until then the phase says so, whatever else is computed.
    pub(super) fn waits_for(&self, what: &'static str) -> Waiting<'_> {
        self.change_waiting(|(waiting, _)| (waiting + 1, what));
        Waiting { watch: self }
    }

    fn change_waiting(&self, change: impl FnOnce((u32, &'static str)) -> (u32, &'static str)) {
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.waiting = change(done.waiting);
        self.tell(&mut done);
    }

    /// Reports that `finished` speeds are done: before this start of the service, or by the task that calls.
    pub(super) fn speeds_finished(&self, finished: u32, last: Option<u32>) {
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.finished = done.finished.max(finished);
        if let Some(speed) = last {
            done.running.remove(&speed);
        }
        self.report_speeds(&mut done);
    }

    /// Tells how many speeds were asked for, which may be joined by others, and whether control runs follow.
    pub(super) fn expect_phases(&self, asked: u32, may_grow: bool, has_controls: bool) {
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.asked = Some(asked);
        let controls = has_controls.then_some("control runs");
        let added = may_grow.then_some("speeds around peaks");
        done.follows = [vec![added, controls], vec![controls]].map(|phases| {
            let phases: Vec<&str> = phases.into_iter().flatten().collect();
            if phases.is_empty() { String::new() } else { format!("; {} follow", phases.join(" and ")) }
        });
    }

    /// Raises the number of speeds that the job has.
    pub(super) fn expect_speeds(&self, speeds: u32) {
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        if speeds > done.speeds {
            done.speeds = speeds;
            done.pace.reword();
        }
        self.report_speeds(&mut done);
    }

    /// Gives the plan's estimate for all speeds, against which the first results are held.
    pub(super) fn expect_time(&self, plan: CostRange) {
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        let speeds = f64::from(done.speeds);
        done.pace.hold_against(plan, speeds);
    }

    fn report_speeds(&self, done: &mut Done) {
        let (speeds, all) = (done.speeds_done(), f64::from(done.speeds));
        let left = done.pace.words(Instant::now(), speeds, all);
        let phase = match done.asked {
            Some(asked) if done.speeds > asked => format!(
                "added around peaks: {} of {} speeds finished{left}{}",
                done.finished.saturating_sub(asked),
                done.speeds - asked,
                done.follows[1]
            ),
            _ => format!("{} of {} speeds finished{left}{}", done.finished, done.speeds, done.follows[0]),
        };
        self.report(done, &phase, done.percent_of_sweep());
    }

    /// Reports a changed phase or percentage. The percentage never falls; 100 is for the store to give.
    fn report(&self, done: &mut Done, phase: &str, percent: f64) {
        done.percent = done.percent.max(percent.clamp(0.0, 99.0) as u8);
        phase.clone_into(&mut done.phase);
        self.tell(done);
    }

    fn tell(&self, done: &mut Done) {
        let (percent, phase) = (done.percent, done.words());
        if (percent, phase) != (done.reported.0, &done.reported.1) {
            done.reported = (percent, phase.to_owned());
            self.reports.put(self.job, Report { percent, phase: done.reported.1.clone() });
        }
    }
}

/// Guard of a result that waits to be stored.
#[derive(Debug)]
pub(super) struct Waiting<'a> {
    watch: &'a Watch,
}

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        self.watch.change_waiting(|(waiting, what)| (waiting - 1, what));
    }
}

impl Done {
    /// Phase in words: what the job does, or what keeps it from going on.
    fn words(&self) -> &str {
        match self.waiting {
            (0, _) => &self.phase,
            (_, what) => what,
        }
    }

    /// Number of speeds that are done, with fractions of those that are being computed.
    fn speeds_done(&self) -> f64 {
        f64::from(self.finished) + self.running.values().sum::<f64>()
    }

    fn percent_of_sweep(&self) -> f64 {
        // A speed that two tasks happened to run counts once.
        let share = self.speeds_done() / f64::from(self.speeds.max(1));
        REDUCTION_OF_SWEEP + (100.0 - REDUCTION_OF_SWEEP) * share.min(1.0)
    }
}

/// Monitor of a phase that counts for `from` to `to` percent of a job.
#[derive(Debug, Clone)]
pub(super) struct PhaseMonitor {
    watch: Arc<Watch>,
    from: f64,
    to: f64,
}

impl PhaseMonitor {
    /// Monitor of the reduction of a sweep.
    pub(super) fn reduction_of_sweep(watch: Arc<Watch>) -> Self {
        Self { watch, from: 0.0, to: REDUCTION_OF_SWEEP }
    }

    /// Monitor of the reduction of a job that is one computation.
    pub(super) fn reduction_of_once(watch: Arc<Watch>) -> Self {
        Self { watch, from: 0.0, to: REDUCTION_OF_ONCE }
    }

    /// Monitor of that computation.
    pub(super) fn after_reduction(watch: Arc<Watch>) -> Self {
        Self { watch, from: REDUCTION_OF_ONCE, to: 100.0 }
    }

    /// Monitor of a job that is one phase.
    pub(super) fn whole(watch: Arc<Watch>) -> Self {
        Self { watch, from: 0.0, to: 100.0 }
    }

    /// Watch of the job that the phase belongs to.
    pub(super) fn watch(&self) -> &Arc<Watch> {
        &self.watch
    }

    /// Monitor of a phase that counts for nothing but can be cancelled.
    pub(super) fn uncounted(watch: Arc<Watch>) -> Self {
        Self { watch, from: 0.0, to: 0.0 }
    }
}

impl Monitor for PhaseMonitor {
    fn progress(&self, fraction: f64, phase: &str) {
        let mut done = self.watch.done.lock().unwrap_or_else(PoisonError::into_inner);
        let fraction = fraction.clamp(0.0, 1.0);
        let percent = self.from + (self.to - self.from) * fraction;
        // Only the last phase of a job tells how long the job takes.
        if self.to < 100.0 {
            return self.watch.report(&mut done, phase, percent);
        }
        let now = Instant::now();
        done.pace.begin(now, fraction);
        let phase = format!("{phase}{}", done.pace.words(now, fraction, 1.0));
        self.watch.report(&mut done, &phase, percent);
    }

    fn is_cancelled(&self) -> bool {
        self.watch.is_cancelled()
    }
}

/// Monitor of one speed of a sweep.
#[derive(Debug, Clone)]
pub(super) struct SpeedMonitor {
    watch: Arc<Watch>,
    speed: u32,
}

impl SpeedMonitor {
    pub(super) fn new(watch: Arc<Watch>, speed: u32) -> Self {
        Self { watch, speed }
    }
}

impl Monitor for SpeedMonitor {
    /// Reports the number of finished speeds: as speeds run side by side, it says more than the phase of any.
    fn progress(&self, fraction: f64, _phase: &str) {
        let mut done = self.watch.done.lock().unwrap_or_else(PoisonError::into_inner);
        let before = done.speeds_done();
        done.pace.begin(Instant::now(), before);
        done.running.insert(self.speed, fraction.clamp(0.0, 1.0));
        self.watch.report_speeds(&mut done);
    }

    fn is_cancelled(&self) -> bool {
        self.watch.is_cancelled()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn watch(speeds: u32) -> Arc<Watch> {
        Watch::new(JobId::new(), speeds, Arc::default(), Arc::default())
    }

    /// Percentage and phase that are new; `None` if nothing is.
    fn told(watch: &Watch) -> Option<(u8, String)> {
        watch.reports.take().remove(&watch.job).map(|report| (report.percent, report.phase))
    }

    #[test]
    fn progress_counts_work_and_never_falls() {
        let watch = watch(4);
        let mut percents = Vec::new();
        let mut note = || percents.extend(told(&watch).map(|(percent, _)| percent));
        PhaseMonitor::reduction_of_sweep(watch.clone()).progress(0.5, "modes");
        note();
        PhaseMonitor::reduction_of_sweep(watch.clone()).progress(1.0, "modes");
        note();
        let speed = SpeedMonitor::new(watch.clone(), 0);
        speed.progress(0.5, "integrating");
        note();
        speed.progress(0.1, "an earlier attempt, told late");
        note();
        watch.speeds_finished(1, Some(0));
        note();
        PhaseMonitor::uncounted(watch.clone()).progress(0.7, "waiting");
        note();
        watch.speeds_finished(2, Some(1));
        note();
        watch.speeds_finished(4, Some(3));
        note();
        // 10 % for the reduction, the rest by speeds; 100 is for the store to give.
        assert_eq!(percents, [5, 10, 21, 32, 32, 55, 99]);
    }

    #[test]
    fn more_speeds_take_no_progress_back() {
        let watch = watch(2);
        watch.speeds_finished(2, None);
        assert_eq!(told(&watch), Some((99, "2 of 2 speeds finished".to_owned())));
        watch.expect_speeds(4);
        assert_eq!(told(&watch), Some((99, "2 of 4 speeds finished".to_owned())));
        SpeedMonitor::new(watch.clone(), 2).progress(0.5, "integrating");
        assert_eq!(told(&watch), None);
        // A late caller expects fewer speeds.
        watch.expect_speeds(3);
        watch.speeds_finished(3, Some(2));
        assert_eq!(told(&watch), Some((99, "3 of 4 speeds finished".to_owned())));
    }

    #[test]
    fn a_phase_says_what_follows() {
        let watch = watch(2);
        watch.expect_phases(2, true, true);
        watch.speeds_finished(1, None);
        let follow = "; speeds around peaks and control runs follow";
        assert_eq!(told(&watch).unwrap().1, format!("1 of 2 speeds finished{follow}"));
        watch.expect_speeds(5);
        watch.speeds_finished(3, None);
        let added = "added around peaks: 1 of 3 speeds finished; control runs follow";
        assert_eq!(told(&watch).unwrap().1, added);
        watch.expect_phases(5, false, false);
        watch.speeds_finished(4, None);
        assert_eq!(told(&watch).unwrap().1, "4 of 5 speeds finished");
    }

    #[test]
    fn a_new_phase_is_news_and_only_the_latest_counts() {
        let watch = watch(1);
        let monitor = PhaseMonitor::reduction_of_once(watch.clone());
        monitor.progress(0.5, "harmonic 1");
        assert_eq!(told(&watch), Some((45, "harmonic 1".to_owned())));
        monitor.progress(0.5, "harmonic 1");
        assert_eq!(told(&watch), None);
        monitor.progress(0.501, "harmonic 2");
        monitor.progress(0.502, "harmonic 3");
        assert_eq!(told(&watch), Some((45, "harmonic 3".to_owned())));
        // A restart goes through finished phases again.
        monitor.progress(0.1, "harmonic 0");
        assert_eq!(told(&watch), Some((45, "harmonic 0".to_owned())));
    }

    #[test]
    fn a_result_that_waits_is_the_phase_until_it_is_stored() {
        let watch = watch(3);
        let speed = SpeedMonitor::new(watch.clone(), 1);
        speed.progress(0.1, "integrating");
        let [first, second] = [watch.waits_for("no room"), watch.waits_for("no room")];
        assert_eq!(told(&watch).unwrap().1, "no room");
        // Others go on computing meanwhile.
        speed.progress(0.11, "integrating");
        drop(first);
        assert_eq!((told(&watch), watch.phase().as_deref()), (None, Some("no room")));
        drop(second);
        assert_eq!(told(&watch).unwrap().1, "0 of 3 speeds finished");
    }

    #[test]
    fn dismissal_and_shutdown_are_both_seen() {
        let first = watch(1);
        assert!(!first.is_cancelled());
        first.dismiss();
        assert!(SpeedMonitor::new(first, 0).is_cancelled());

        let second = watch(1);
        second.stopping.store(true, Ordering::Relaxed);
        assert!(PhaseMonitor::uncounted(second).is_cancelled());
    }
}
