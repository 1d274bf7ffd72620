//! Progress of a job as one number, and cancellation, as the computations see them.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use tokio::sync::mpsc;

use crate::analysis::monitor::Monitor;
use crate::store::jobs::JobId;

/// Percent of a sweep that its reduction counts for.
const REDUCTION_OF_SWEEP: f64 = 10.0;
/// Percent of a modal analysis that its reduction counts for: nearly all the work.
const REDUCTION_OF_MODAL_ANALYSIS: f64 = 90.0;

/// News about a job's progress, on its way to the store.
#[derive(Debug)]
pub(super) struct Report {
    pub(super) job: JobId,
    pub(super) percent: u8,
    pub(super) phase: String,
}

/// Watches all computations of one job.
#[derive(Debug)]
pub(super) struct Watch {
    job: JobId,
    dismissed: AtomicBool,
    stopping: Arc<AtomicBool>,
    done: Mutex<Done>,
    reports: mpsc::UnboundedSender<Report>,
}

/// How much of a job is done.
#[derive(Debug, Default)]
struct Done {
    /// Last percentage reported.
    percent: u8,
    speeds: u32,
    finished: u32,
    /// Fractions of the speeds that are being computed.
    running: HashMap<u32, f64>,
}

impl Watch {
    pub(super) fn new(
        job: JobId,
        speeds: u32,
        stopping: Arc<AtomicBool>,
        reports: mpsc::UnboundedSender<Report>,
    ) -> Arc<Self> {
        let done = Mutex::new(Done { speeds, ..Done::default() });
        Arc::new(Self { job, dismissed: AtomicBool::new(false), stopping, done, reports })
    }

    /// Tells all computations of the job to stop.
    pub(super) fn dismiss(&self) {
        self.dismissed.store(true, Ordering::Relaxed);
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.dismissed.load(Ordering::Relaxed) || self.stopping.load(Ordering::Relaxed)
    }

    /// `finished` speeds are done: before this start of the service, or by the one that calls.
    pub(super) fn speeds_finished(&self, finished: u32, last: Option<u32>) {
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.finished = done.finished.max(finished);
        if let Some(speed) = last {
            done.running.remove(&speed);
        }
        let phase = format!("{} of {} speeds finished", done.finished, done.speeds);
        self.report(&mut done, &phase, None);
    }

    /// Reports if the percentage has grown: at most a hundred times in the life of a job.
    fn report(&self, done: &mut Done, phase: &str, percent: Option<f64>) {
        let percent = percent.unwrap_or_else(|| done.percent_of_sweep()).clamp(0.0, 99.0) as u8;
        if percent > done.percent {
            done.percent = percent;
            // The receiver outlives all jobs, except while the service stops.
            let _ = self.reports.send(Report { job: self.job, percent, phase: phase.to_owned() });
        }
    }
}

impl Done {
    fn percent_of_sweep(&self) -> f64 {
        // A speed that two tasks happened to run counts once.
        let speeds = f64::from(self.finished) + self.running.values().sum::<f64>();
        let share = speeds / f64::from(self.speeds.max(1));
        REDUCTION_OF_SWEEP + (100.0 - REDUCTION_OF_SWEEP) * share.min(1.0)
    }
}

/// Watches a phase that counts for `from` to `to` percent of a job.
#[derive(Debug, Clone)]
pub(super) struct PhaseMonitor {
    watch: Arc<Watch>,
    from: f64,
    to: f64,
}

impl PhaseMonitor {
    /// The reduction of a sweep.
    pub(super) fn reduction_of_sweep(watch: Arc<Watch>) -> Self {
        Self { watch, from: 0.0, to: REDUCTION_OF_SWEEP }
    }

    /// The reduction of a modal analysis.
    pub(super) fn reduction_of_modal_analysis(watch: Arc<Watch>) -> Self {
        Self { watch, from: 0.0, to: REDUCTION_OF_MODAL_ANALYSIS }
    }

    /// The modal analysis proper.
    pub(super) fn modal_analysis(watch: Arc<Watch>) -> Self {
        Self { watch, from: REDUCTION_OF_MODAL_ANALYSIS, to: 100.0 }
    }

    /// A phase that counts for nothing but can be cancelled.
    pub(super) fn uncounted(watch: Arc<Watch>) -> Self {
        Self { watch, from: 0.0, to: 0.0 }
    }
}

impl Monitor for PhaseMonitor {
    fn progress(&self, fraction: f64, phase: &str) {
        let mut done = self.watch.done.lock().unwrap_or_else(PoisonError::into_inner);
        let percent = self.from + (self.to - self.from) * fraction.clamp(0.0, 1.0);
        self.watch.report(&mut done, phase, Some(percent));
    }

    fn is_cancelled(&self) -> bool {
        self.watch.is_cancelled()
    }
}

/// Watches one speed of a sweep.
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
    fn progress(&self, fraction: f64, phase: &str) {
        let mut done = self.watch.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.running.insert(self.speed, fraction.clamp(0.0, 1.0));
        self.watch.report(&mut done, phase, None);
    }

    fn is_cancelled(&self) -> bool {
        self.watch.is_cancelled()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn watch(speeds: u32) -> (Arc<Watch>, mpsc::UnboundedReceiver<Report>) {
        let (sender, receiver) = mpsc::unbounded_channel();
        (Watch::new(JobId::new(), speeds, Arc::default(), sender), receiver)
    }

    fn percents(mut reports: mpsc::UnboundedReceiver<Report>) -> Vec<u8> {
        std::iter::from_fn(|| reports.try_recv().ok().map(|report| report.percent)).collect()
    }

    #[test]
    fn progress_counts_work_and_never_falls() {
        let (watch, reports) = watch(4);
        PhaseMonitor::reduction_of_sweep(watch.clone()).progress(0.5, "modes");
        PhaseMonitor::reduction_of_sweep(watch.clone()).progress(1.0, "modes");
        let speed = SpeedMonitor::new(watch.clone(), 0);
        speed.progress(0.5, "integrating");
        speed.progress(0.1, "an earlier attempt, told late");
        watch.speeds_finished(1, Some(0));
        watch.speeds_finished(2, Some(1));
        watch.speeds_finished(4, Some(3));
        // 10 % for the reduction, the rest by speeds; 100 is for the store to give.
        assert_eq!(percents(reports), [5, 10, 21, 32, 55, 99]);
    }

    #[test]
    fn dismissal_and_shutdown_are_both_seen() {
        let (first, _reports) = watch(1);
        assert!(!first.is_cancelled());
        first.dismiss();
        assert!(SpeedMonitor::new(first, 0).is_cancelled());

        let (second, _reports) = watch(1);
        second.stopping.store(true, Ordering::Relaxed);
        assert!(PhaseMonitor::uncounted(second).is_cancelled());
    }
}
