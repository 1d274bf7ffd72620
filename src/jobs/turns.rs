//! Turns of waiting tasks: they are handed out so that owners take turns, and the jobs of each owner.

use std::collections::{HashMap, HashSet, VecDeque};
use std::hash::Hash;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::store::jobs::JobId;

/// Waiting tasks of all jobs, and which of them are out.
///
/// Few are out at once: what a queue has, it runs in order of arrival, and a job of one speed that came after ten
/// thousand of another would wait for all of them there.
#[derive(Debug)]
pub(super) struct Turns<T> {
    most: usize,
    most_of_one: usize,
    lines: Mutex<Lines<T>>,
}

#[derive(Debug)]
struct Lines<T> {
    /// Lines of waiting tasks, one for each owner; the first is next.
    owners: VecDeque<Line<T>>,
    /// Tasks that are out, with their owners.
    out: HashMap<(JobId, T), String>,
}

/// Jobs of one owner that have tasks waiting; the first is next.
#[derive(Debug)]
struct Line<T> {
    owner: String,
    jobs: VecDeque<(JobId, VecDeque<T>)>,
}

impl<T: Copy + Eq + Hash> Turns<T> {
    /// Makes turns in which no more than `most` tasks are out at once, and no more than `most_of_one` of one owner.
    pub(super) fn new(most: usize, most_of_one: usize) -> Self {
        let lines = Lines { owners: VecDeque::new(), out: HashMap::new() };
        Self { most, most_of_one, lines: Mutex::new(lines) }
    }

    /// Adds tasks of a job, to be handed out in this order. Those that wait or are out already are not added again.
    pub(super) fn add(&self, owner: &str, job: JobId, tasks: impl IntoIterator<Item = T>) {
        let Lines { owners, out } = &mut *self.lock();
        let mut known = HashSet::new();
        let new = |task: &T| !out.contains_key(&(job, *task)) && known.insert(*task);
        let mut tasks: Vec<T> = tasks.into_iter().filter(new).collect();
        let line = match owners.iter().position(|line| line.owner == owner) {
            Some(place) => &mut owners[place],
            None => {
                owners.push_back(Line { owner: owner.to_owned(), jobs: VecDeque::new() });
                let last = owners.len() - 1;
                &mut owners[last]
            }
        };
        match line.jobs.iter_mut().find(|(known, _)| *known == job) {
            Some((_, waiting)) => {
                let known: HashSet<T> = waiting.iter().copied().collect();
                tasks.retain(|task| !known.contains(task));
                waiting.extend(tasks);
            }
            None => line.jobs.push_back((job, tasks.into())),
        }
        owners.retain_mut(|line| {
            line.jobs.retain(|(_, waiting)| !waiting.is_empty());
            !line.jobs.is_empty()
        });
    }

    /// Takes the next task; `None` while none waits or enough are out.
    pub(super) fn next(&self) -> Option<(JobId, T)> {
        let Lines { owners, out } = &mut *self.lock();
        if out.len() >= self.most {
            return None;
        }
        let may =
            |line: &Line<T>| out.values().filter(|owner| **owner == line.owner).count() < self.most_of_one;
        let place = owners.iter().position(may)?;
        let mut line = owners.remove(place)?;
        let (job, mut waiting) = line.jobs.pop_front()?;
        let task = waiting.pop_front()?;
        if !waiting.is_empty() {
            line.jobs.push_back((job, waiting));
        }
        out.insert((job, task), line.owner.clone());
        if !line.jobs.is_empty() {
            owners.push_back(line);
        }
        Some((job, task))
    }

    /// Records that a task that was out has ended.
    pub(super) fn done(&self, job: JobId, task: T) {
        self.lock().out.remove(&(job, task));
    }

    /// Drops the waiting tasks of a job.
    pub(super) fn withdraw(&self, job: JobId) {
        self.lock().owners.retain_mut(|line| {
            line.jobs.retain(|(known, _)| *known != job);
            !line.jobs.is_empty()
        });
    }

    fn lock(&self) -> MutexGuard<'_, Lines<T>> {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn owners_take_turns_and_so_do_their_jobs() {
        let turns = Turns::new(100, 100);
        let [long, short, other] = [JobId::new(), JobId::new(), JobId::new()];
        turns.add("a", long, 0..10_000);
        turns.add("a", short, [0]);
        turns.add("b", other, 0..2);
        let next: Vec<_> = (0..6).map_while(|_| turns.next()).collect();
        assert_eq!(next, [(long, 0), (other, 0), (short, 0), (other, 1), (long, 1), (long, 2)]);
    }

    #[test]
    fn no_more_are_out_than_may_be_and_none_twice() {
        let turns = Turns::new(2, 2);
        let job = JobId::new();
        turns.add("", job, [5, 3, 5, 4]);
        // A repeated preparation adds what is there already.
        turns.add("", job, [3, 4, 5]);
        assert_eq!((turns.next(), turns.next(), turns.next()), (Some((job, 5)), Some((job, 3)), None));
        turns.add("", job, [3, 4, 5]);
        turns.done(job, 5);
        assert_eq!((turns.next(), turns.next()), (Some((job, 4)), None));
        turns.done(job, 3);
        assert_eq!(turns.next(), None, "nothing waits");
        // An ended task may come again.
        turns.add("", job, [3]);
        assert_eq!(turns.next(), Some((job, 3)));
    }

    #[test]
    fn one_owner_leaves_room_for_others() {
        let turns = Turns::new(4, 2);
        let [many, one] = [JobId::new(), JobId::new()];
        turns.add("a", many, 0..9);
        assert_eq!((turns.next(), turns.next(), turns.next()), (Some((many, 0)), Some((many, 1)), None));
        turns.add("b", one, [7]);
        assert_eq!((turns.next(), turns.next()), (Some((one, 7)), None));
        turns.done(many, 0);
        assert_eq!(turns.next(), Some((many, 2)));
    }

    #[test]
    fn a_withdrawn_job_keeps_nobody_waiting() {
        let turns = Turns::new(9, 9);
        let [gone, stays] = [JobId::new(), JobId::new()];
        turns.add("a", gone, 0..5);
        turns.add("b", stays, 0..1);
        turns.withdraw(gone);
        assert_eq!((turns.next(), turns.next()), (Some((stays, 0)), None));
    }
}
