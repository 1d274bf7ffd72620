//! Results of a run: credentials, spectra and steady response of one speed.

use crate::contact::ContactOf;
use crate::digits::digits;
use crate::effects::casing::shape::Shape;
use crate::effects::effect::Ran;
use crate::effects::symmetry::repeats::repeats;
use crate::effects::table::named;
use crate::error::AnalysisError;
use crate::peak_to_peak::half_peak_to_peak;
use crate::resolved::{ResolvedSensor, ResolvedSweep};
use crate::result::{
    ContactForces, ContactSummary, EnergyReport, Point, PointStatus, SensorResponse, SensorSpectrum,
    SpeedSpectra,
};
use crate::speed_scene::SpeedScene;
use crate::steady::{Simulated, marched};
use crate::tips::largest_tip;
use rubmap_numerics::sector_fourier::{SectorFourier, harmonic_count};
use rubmap_numerics::spectrum::amplitudes;
use rubmap_wheel::dynamics::integrate::{Divergence, History, Outcome, Run, TipDisplacement};
use rubmap_wheel::dynamics::modal_wheel::ModalWheel;
use rubmap_wheel::response::settling::judge;
use rubmap_wheel::response::side_bands::{SideBands, side_bands};
use rubmap_wheel::response::spectra::{engine_orders, nodal_diameter_amplitudes};

/// Results of a complete run beside its point.
pub(super) struct Recorded {
    pub(super) spectra: SpeedSpectra,
    /// Contact forces, for a scene with contact.
    pub(super) contact: Option<ContactForces>,
}

/// Writes a run's credentials into `point`; returns the other results if it is complete. A scene that repeats was run on one part of the
/// wheel: sums over the wheel are multiplied here.
pub(super) fn record_run(
    point: &mut Point,
    simulated: &Simulated,
    scene: &SpeedScene<'_>,
) -> Result<Option<Recorded>, AnalysisError> {
    let Simulated { run, steady } = simulated;
    let SpeedScene { sector, request, wheel, stepping } = scene;
    (point.march, point.steady) = (marched(request, run, steady.as_ref()), steady.clone());
    let parts = wheel.repeats as f64;
    let steps = &stepping.discretisation;
    point.smallest_stable_steps_per_revolution = stepping.smallest as u32;
    point.steps_per_revolution = steps.per_revolution as u32;
    point.scheme = Some(stepping.report.clone());
    point.steps = run.statistics.steps + searched(point, steps.per_revolution);
    point.contact_share = run.statistics.contact_share();
    // A run that overflowed has sums that are no numbers; JSON has no word for them.
    let finite = |value: f64| value.is_finite().then_some(value);
    point.contact_impulse = finite(parts * run.statistics.contact_impulse);
    point.largest_penetration = finite(run.statistics.largest_penetration);
    point.smallest_multiplier = run.statistics.smallest_multiplier.and_then(finite);
    point.energy_residual = finite(run.energy.residual()).filter(|_| !overflowed(&run.outcome));
    point.energy = EnergyReport::of(&run.energy, parts);
    point.largest_energy = finite(parts * run.energy.largest_energy());
    let clearance = scene.lasting_clearance();
    if let Some(clearance) = clearance.as_ref().filter(|_| request.has_cold_clearances()) {
        point.running_clearance.clone_from(clearance);
    }
    let recorded = match &run.outcome {
        Outcome::Cancelled => return Err(AnalysisError::Cancelled),
        Outcome::Completed(history) => {
            point.status = PointStatus::Completed;
            let spectra = spectra(history, request, wheel);
            let window = request.integration.window_revolutions as usize;
            point.responses = responses(history, request, &spectra);
            let lobes = request.scene.touched_shape().and_then(Shape::repeats);
            // A period is held against the one before.
            let judged = history.repeated.map_or(window, |repeated| window.max(2 * repeated.period));
            let settling = judge(&history.displacement, steps.samples, judged, lobes);
            point.settling = Some(settling.beside(strongest_side_bands(&point.responses)));
            let contact = contact(run, scene, clearance.as_deref());
            let (summary, forces) = contact.unzip();
            point.contact = summary;
            point.tip = largest_tip(&history.tips, clearance.as_deref(), &sector.wheel.contact);
            Some(Recorded { spectra, contact: forces })
        }
        outcome => {
            if let Some((status, message)) = cut_short(outcome, &sector.units.length) {
                (point.status, point.message) = (status, Some(message));
            }
            None
        }
    };
    let repeats = repeats(&request.scene, wheel.sectors as u32) as usize;
    let ran = Ran { run, request, parts, repeats };
    named(&request.scene).filter_map(|effect| effect.record).for_each(|record| record(point, &ran));
    Ok(recorded)
}

/// Number of steps that the search for a periodic response took.
fn searched(point: &Point, steps_per_revolution: usize) -> u64 {
    let revolutions = point.steady.as_ref().map_or(0.0, |steady| steady.revolutions);
    (revolutions * steps_per_revolution as f64).round() as u64
}

/// Contact over the window, as a summary and in full; none for a scene without contact.
fn contact(
    run: &Run,
    scene: &SpeedScene<'_>,
    clearance: Option<&[f64]>,
) -> Option<(ContactSummary, ContactForces)> {
    let SpeedScene { request, wheel, stepping, .. } = scene;
    let of = ContactOf {
        record: run.contact.as_ref()?,
        wheel,
        clearance: clearance?,
        window_revolutions: f64::from(request.integration.window_revolutions),
        steps_per_revolution: stepping.discretisation.per_revolution,
        samples_per_revolution: stepping.discretisation.samples,
    };
    let forces = of.forces();
    Some((of.summary(&forces), forces))
}

/// Status and message, with the unit of `length`, of a run that ended early; none for a complete or a cancelled run.
pub(super) fn cut_short(outcome: &Outcome, length: &str) -> Option<(PointStatus, String)> {
    match outcome {
        Outcome::Diverged(divergence) => Some((PointStatus::Diverged, describe(divergence, length))),
        Outcome::ContactFailed { revolutions, error } => {
            Some((PointStatus::Failed, format!("after {revolutions:.4} revolutions {error}")))
        }
        Outcome::Completed(_) | Outcome::Cancelled => None,
    }
}

/// Whether numbers overflowed, so that no sum over the run means anything.
fn overflowed(outcome: &Outcome) -> bool {
    let Outcome::Diverged(divergence) = outcome else { return false };
    divergence.tip.is_none_or(|tip| !tip.displacement.is_finite())
}

fn describe(divergence: &Divergence, length: &str) -> String {
    let Divergence { revolutions, tip, energy_growth } = *divergence;
    // Of a motion that was thrown out at once the energy may have fallen since.
    let growth = energy_growth.filter(|growth| growth.is_finite() && *growth > 1.0);
    let energy = growth.map_or_else(String::new, |growth| {
        format!("; the energy was {} times that at the end of the last whole revolution", digits(growth))
    });
    match tip.filter(|tip| tip.displacement.is_finite()) {
        Some(TipDisplacement { displacement, contact_node, sector, component }) => format!(
            "{}: after {revolutions:.3} revolutions contact node {contact_node} of sector {sector} had moved {component} by {} {length}, \
             more than a tenth of the wheel's radius{energy}",
            if growth.is_some() { "the response grew without bound" } else { "the motion left the bounds" },
            digits(displacement),
        ),
        None => format!(
            "the response grew without bound: numbers overflowed after {revolutions:.3} revolutions{energy}"
        ),
    }
}

fn spectra(history: &History, request: &ResolvedSweep, wheel: &ModalWheel) -> SpeedSpectra {
    let engine_orders = engine_orders(request.integration.window_revolutions, request.max_engine_order);
    let bins = engine_orders.len();
    let fourier = SectorFourier::new(wheel.sectors);
    let sensors = request.sensors.iter().enumerate().map(|(index, &sensor)| {
        let columns = &history.harmonics[index];
        SensorSpectrum {
            sensor: sensor.into(),
            amplitude: amplitudes(&history.window[index], bins),
            nodal_diameters: of_the_wheel(nodal_diameter_amplitudes(columns, &fourier, bins), wheel),
        }
    });
    SpeedSpectra { sensors: sensors.collect(), engine_orders }
}

/// Amplitudes per nodal diameter of the whole wheel from those of one of its parts; all other nodal diameters are zero.
fn of_the_wheel(part: Vec<Vec<f64>>, wheel: &ModalWheel) -> Vec<Vec<f64>> {
    if wheel.repeats == 1 {
        return part;
    }
    let bins = part.first().map_or(0, Vec::len);
    let mut whole = vec![vec![0.0; bins]; harmonic_count(wheel.around())];
    let scale = (wheel.repeats as f64).sqrt();
    for (index, line) in part.into_iter().enumerate() {
        whole[index * wheel.repeats] = line.into_iter().map(|amplitude| scale * amplitude).collect();
    }
    whole
}

/// Share of the largest displacement below which lines are round-off: some thousand roundings of it.
const ROUND_OFF: f64 = 1e-12;

fn responses(history: &History, request: &ResolvedSweep, spectra: &SpeedSpectra) -> Vec<SensorResponse> {
    let window_samples = history.window.first().map_or(0, Vec::len);
    let windows = history.displacement.iter().map(|whole| &whole[whole.len() - window_samples..]);
    let round_off = ROUND_OFF * windows.flatten().fold(0.0f64, |most, x| most.max(x.abs()));
    let of = |(index, &sensor): (usize, &ResolvedSensor)| {
        let whole = &history.displacement[index];
        let window = &whole[whole.len() - window_samples..];
        let mean = window.iter().sum::<f64>() / window.len() as f64;
        let variance = window.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / window.len() as f64;
        let spectrum = &spectra.sensors[index];
        let bin = largest_bin(&spectrum.amplitude[1..]) + 1;
        let carried: Vec<f64> = spectrum.nodal_diameters.iter().map(|line| line[bin]).collect();
        let stands_out = spectrum.amplitude[bin] > round_off;
        SensorResponse {
            sensor: sensor.into(),
            mean,
            rms: variance.sqrt(),
            half_peak_to_peak: half_peak_to_peak(window),
            dominant_engine_order: stands_out.then(|| spectra.engine_orders[bin]),
            dominant_nodal_diameter: stands_out.then(|| largest_bin(&carried) as u32),
            side_bands: side_bands(
                &history.window[index],
                request.integration.window_revolutions as usize,
                request.max_engine_order as usize,
            ),
        }
    };
    request.sensors.iter().enumerate().map(of).collect()
}

/// Strongest pair of side bands at the sensor with the largest response.
fn strongest_side_bands(responses: &[SensorResponse]) -> Option<&SideBands> {
    let loudest = responses.iter().max_by(|a, b| a.rms.total_cmp(&b.rms))?;
    loudest.side_bands.iter().max_by(|a, b| a.weaker().total_cmp(&b.weaker()))
}

fn largest_bin(values: &[f64]) -> usize {
    values.iter().enumerate().fold(0, |best, (i, v)| if *v > values[best] { i } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rubmap_wheel::dynamics::integrate::TipComponent;

    #[test]
    fn a_divergence_is_told_as_people_do() {
        let told = |displacement: f64, energy_growth: Option<f64>| {
            let tip =
                TipDisplacement { displacement, contact_node: 3, sector: 2, component: TipComponent::Radial };
            describe(&Divergence { revolutions: 0.5, tip: Some(tip), energy_growth }, "mm")
        };
        let moved = "after 0.500 revolutions contact node 3 of sector 2 had moved radially by 13.1 mm, more than a tenth of the wheel's radius";
        let grown = format!(
            "the response grew without bound: {moved}; the energy was 3.21 times that at the end of the last whole revolution"
        );
        assert_eq!(told(13.06, Some(3.2123)), grown);
        // Energy that has fallen, or that is not known, has not grown.
        for energy in [Some(0.9157), None] {
            assert_eq!(told(13.06, energy), format!("the motion left the bounds: {moved}"));
        }
        assert!(told(f64::NAN, None).contains("numbers overflowed after 0.500 revolutions"));
    }
}
