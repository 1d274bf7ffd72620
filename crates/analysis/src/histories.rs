//! Histories of one speed of a sweep, which is simulated again to record them.

use std::borrow::Cow;

use crate::component::{along, direction};
use crate::effects::casing::convert::heights_before;
use crate::error::AnalysisError;
use crate::model::ReducedSector;
use crate::monitor::Monitor;
use crate::record::record_run;
use crate::request::{Recorded, RecordedQuantity};
use crate::resolve::recorded::{asked, revolutions, wanted};
use crate::resolved::sensor::{Along, Place};
use crate::resolved::{ResolvedCaseStudy, ResolvedSensor, ResolvedSweep};
use crate::result::{
    ContactHistory, EnergyHistory, Point, PointStatus, SensorHistory, SpeedHistories, TipPlace,
};
use crate::speed::{empty_point, state_before};
use crate::speed_scene::{Recording, SpeedScene, Start};
use crate::summary::critical_indices;
use rubmap_wheel::dynamics::energy::{EffectWork, EnergyAudit};
use rubmap_wheel::dynamics::integrate::{Detail, DetailHistory, History, Outcome};
use rubmap_wheel::dynamics::states::WheelStates;
use rubmap_wheel::revision::VERSION;

/// Case study for the histories that a sweep asks for, if there is a speed to record, from the points of all its speeds.
pub fn histories_wanted(sweep: &ResolvedSweep, points: &[Point]) -> Option<ResolvedCaseStudy> {
    let request = sweep.histories()?;
    let speeds = wanted(request, &critical_indices(sweep, points));
    let case = ResolvedCaseStudy { sweep: sweep.clone(), speeds, record: request.recorded() };
    (!case.speeds.is_empty()).then_some(case)
}

/// Simulates speed `place` of a case study and records it: the same run as in the sweep, to the bit. In a sweep up or down the speeds
/// before it are simulated as well. Histories of a speed that was not completed are empty, and its point says why.
///
/// # Errors
/// Cancellation.
pub fn speed_histories(
    reduced: &ReducedSector,
    case: &ResolvedCaseStudy,
    place: usize,
    monitor: &dyn Monitor,
) -> Result<SpeedHistories, AnalysisError> {
    let ResolvedCaseStudy { sweep, record, .. } = case;
    let index = case.speeds[place] as usize;
    let start = state_before(reduced, sweep, index, monitor)?;
    let mut point = empty_point(reduced, sweep, index, sweep.speeds.rad_s()[index]);
    let asked = asked(record, sweep);
    let touches = sweep.scene.contact.is_some();
    let detail = Detail {
        revolutions: asked,
        velocity: record.wants(RecordedQuantity::Velocity),
        contact: touches && record.wants(RecordedQuantity::Contact),
        forces: touches && record.wants(RecordedQuantity::ContactForce),
        energy: record.wants(RecordedQuantity::Energy),
    };
    let watch = |fraction: f64| {
        monitor.progress(fraction, "recording histories");
        !monitor.is_cancelled()
    };
    let from_where = start.as_ref().map_or(Start::Scene, Start::After);
    let scene = SpeedScene::new(reduced, Cow::Borrowed(sweep), point.speed_rad_s);
    let ran = scene.and_then(|scene| {
        let states = record.wants(RecordedQuantity::State).then_some(detail.revolutions);
        let simulated = scene.simulate(from_where, Recording { detail: Some(detail), states }, &watch)?;
        Ok((scene, simulated))
    });
    let mut histories = SpeedHistories {
        index: index as u32,
        speed_rad_s: point.speed_rad_s,
        samples_per_revolution: 0,
        revolutions: whole(revolutions(record, sweep)),
        sensors: Vec::new(),
        contact: None,
        energy: None,
        point: point.clone(),
        units: reduced.units.clone(),
        settings: sweep.clone().into(),
        version: VERSION.to_owned(),
        states: None,
    };
    match ran {
        Err(reason) => point.message = Some(reason.to_string()),
        Ok((scene, simulated)) => {
            record_run(&mut point, &simulated, &scene)?;
            let wheel = &scene.wheel;
            if let (PointStatus::Completed, Outcome::Completed(history)) =
                (point.status, &simulated.run.outcome)
            {
                let samples = scene.stepping.discretisation.samples;
                histories.samples_per_revolution = samples as u32;
                let (from, to) = asked.of(sweep.integration.revolutions() as usize, history.repeated);
                histories.revolutions = whole((from, to));
                histories.sensors = sensors(&scene, history, record, samples * from..samples * to);
                if let Some(states) = &history.states {
                    let stiffening = sweep.scene.centrifugal_stiffening;
                    let states = WheelStates::of(states, wheel, &reduced.wheel, stiffening);
                    // This cannot fail: the wheel was made of the same data a moment ago.
                    histories.states = states.ok().map(Box::new);
                }
                if let Some(detail) = &history.detail {
                    histories.contact = detail_contact(detail, wheel.sectors, wheel.repeats);
                    histories.energy = energy(&detail.energy, &point, wheel.repeats);
                }
            }
        }
    }
    histories.point = point;
    Ok(histories)
}

fn whole((from, to): (usize, usize)) -> [u32; 2] {
    [from as u32, to as u32]
}

fn sensors(
    scene: &SpeedScene<'_>,
    history: &History,
    record: &Recorded,
    samples: std::ops::Range<usize>,
) -> Vec<SensorHistory> {
    let velocity = history.detail.as_ref().map_or(&[][..], |detail| &detail.velocity);
    let of = |(sensor, &at): (usize, &ResolvedSensor)| SensorHistory {
        sensor: at.into(),
        tip: tip(scene, at),
        displacement: match record.wants(RecordedQuantity::Displacement) {
            true => history.displacement[sensor][samples.clone()].to_vec(),
            false => Vec::new(),
        },
        velocity: velocity.get(sensor).cloned().unwrap_or_default(),
    };
    scene.request.sensors.iter().enumerate().map(of).collect()
}

/// Least cosine of the angle to the contact normal at which a sensor measures the distance to the casing: eight degrees.
const OUTWARD: f64 = 0.99;

/// Position of a sensor on the contact line relative to the casing, if there is one and the sensor measures towards it.
fn tip(scene: &SpeedScene<'_>, sensor: ResolvedSensor) -> Option<TipPlace> {
    let reduced = scene.sector;
    let contact = &reduced.wheel.contact;
    let node = match sensor.place {
        Place::Contact(node) => node as usize,
        Place::Node(id) => contact.iter().position(|node| node.id == id)?,
        Place::Gauge(_) => return None,
    };
    let components = match sensor.along {
        Along::Component(component) => direction(contact, node, component).components,
        Along::Direction(vector) => along(vector),
        Along::Strain => return None,
    };
    let normal = contact[node].normal;
    if components.iter().zip(normal).map(|(d, n)| d * n).sum::<f64>() < OUTWARD {
        return None;
    }
    let turn = f64::from(sensor.sector) * std::f64::consts::TAU / reduced.wheel.sectors as f64;
    Some(TipPlace {
        angle_rad: contact[node].position[1] + turn,
        clearance: scene.lasting_clearance()?[node],
        heights: heights_before(contact, node, &scene.request),
    })
}

/// Contact history of the whole wheel from that of one part: sums over the wheel are multiplied by `repeats`.
fn detail_contact(detail: &DetailHistory, sectors: usize, repeats: usize) -> Option<ContactHistory> {
    if detail.force.is_empty() && detail.nodes_in_contact.is_empty() {
        return None;
    }
    let of_the_wheel = |line: &[f64]| line.iter().map(|value| repeats as f64 * value).collect();
    let nodes = detail.force.len() / sectors;
    Some(ContactHistory {
        force: detail.force.chunks(nodes.max(1)).map(<[Vec<f64>]>::to_vec).collect(),
        nodes_in_contact: of_the_wheel(&detail.nodes_in_contact),
        contact_length: of_the_wheel(&detail.contact_length),
    })
}

/// Energy history of the whole wheel: the parts of the energy that `point` names.
fn energy(audits: &[EnergyAudit], point: &Point, repeats: usize) -> Option<EnergyHistory> {
    let (named, first) = (point.energy?, audits.first()?);
    let line = |of: &dyn Fn(&EnergyAudit) -> f64| -> Vec<f64> {
        audits.iter().map(|audit| repeats as f64 * of(audit)).collect()
    };
    let effect = |named: Option<f64>, of: fn(EffectWork) -> f64| match named {
        Some(_) => line(&|audit| of(audit.effects())),
        None => Vec::new(),
    };
    Some(EnergyHistory {
        initial: repeats as f64 * first.ends().0,
        mechanical: line(&|audit| audit.ends().1),
        contact_work: line(&EnergyAudit::work),
        damping_loss: line(&EnergyAudit::loss),
        excitation_work: effect(named.excitation_work, |work| work.excitation),
        mistuning_work: effect(named.mistuning_work, |work| work.mistuning),
        bending_work: effect(named.bending_work, |work| work.stiffening),
        casing_work: effect(named.casing_work, |work| work.casing),
        casing_loss: effect(named.casing_loss, |work| work.casing_loss),
        friction_heat: effect(named.friction_heat, |work| work.friction_heat),
    })
}
