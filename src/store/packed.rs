//! Spectra packed without loss, to the bit.
//!
//! Data shared by sensors at the same contact node is stored once. Then the bytes of all numbers are sorted by their position in the number
//! before they are deflated: signs and exponents of neighbouring lines are alike, the remaining bytes are not.

use std::io::{Read, Write};

use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;
use serde::{Deserialize, Serialize};

use super::error::StoreError;
use super::stored_sensor::StoredSensor;
use crate::analysis::result::{SensorSpectrum, SpeedSpectra};

/// Size of a number, bytes.
const REAL: usize = size_of::<f64>();

/// Spectra as they are stored.
#[derive(Debug, Serialize, Deserialize)]
struct Packed {
    sensors: Vec<(StoredSensor, Waves)>,
    /// Length of each line of numbers: the engine orders, then per sensor its amplitudes and its own nodal diameters.
    lengths: Vec<u32>,
    /// Numbers of all lines, deflated: the first bytes of all, then the second ones, and so on.
    numbers: Vec<u8>,
}

/// Amplitudes per nodal diameter of a sensor.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
enum Waves {
    /// Number of lines of its own.
    Own(u32),
    /// Index of an earlier sensor with the same amplitudes.
    Of(u32),
}

/// Packs `spectra`, and returns the bytes that they take unpacked as well.
pub(super) fn pack(spectra: &SpeedSpectra) -> Result<(Vec<u8>, u64), StoreError> {
    let mut lines = vec![&spectra.engine_orders];
    let mut sensors = Vec::with_capacity(spectra.sensors.len());
    let mut unpacked = spectra.engine_orders.len();
    for (index, spectrum) in spectra.sensors.iter().enumerate() {
        unpacked += spectrum.amplitude.len() + spectrum.nodal_diameters.iter().map(Vec::len).sum::<usize>();
        lines.push(&spectrum.amplitude);
        let same = spectra.sensors[..index].iter().position(|before| has_the_waves_of(spectrum, before));
        let waves = match same {
            Some(before) => Waves::Of(before as u32),
            None => {
                lines.extend(&spectrum.nodal_diameters);
                Waves::Own(spectrum.nodal_diameters.len() as u32)
            }
        };
        sensors.push((StoredSensor::of(&spectrum.sensor).ok_or(StoreError::Spectra)?, waves));
    }
    let lengths = lines.iter().map(|line| line.len() as u32).collect();
    let numbers: Vec<[u8; REAL]> = lines.into_iter().flatten().map(|number| number.to_be_bytes()).collect();
    let mut deflated = DeflateEncoder::new(Vec::new(), Compression::fast());
    for place in 0..REAL {
        let bytes: Vec<u8> = numbers.iter().map(|number| number[place]).collect();
        deflated.write_all(&bytes)?;
    }
    let packed = Packed { sensors, lengths, numbers: deflated.finish()? };
    Ok((postcard::to_stdvec(&packed)?, (REAL * unpacked) as u64))
}

/// Whether two sensors have the same amplitudes per nodal diameter, as those of one node do whatever their sector.
fn has_the_waves_of<'a>(one: &'a SensorSpectrum, other: &'a SensorSpectrum) -> bool {
    let place = |spectrum: &SensorSpectrum| StoredSensor::of(&spectrum.sensor).map(StoredSensor::anywhere);
    let lengths =
        |spectrum: &SensorSpectrum| spectrum.nodal_diameters.iter().map(Vec::len).collect::<Vec<_>>();
    let bits = |spectrum: &'a SensorSpectrum| spectrum.nodal_diameters.iter().flatten().map(|x| x.to_bits());
    place(one) == place(other) && lengths(one) == lengths(other) && bits(one).eq(bits(other))
}

/// Unpacks spectra that [`pack`] packed.
pub(super) fn unpack(bytes: &[u8]) -> Result<SpeedSpectra, StoreError> {
    let Packed { sensors, lengths, numbers } = postcard::from_bytes(bytes)?;
    let count: usize = lengths.iter().map(|length| *length as usize).sum();
    let mut bytes = Vec::new();
    DeflateDecoder::new(&*numbers)
        .take((REAL * count) as u64)
        .read_to_end(&mut bytes)
        .map_err(|_| StoreError::Spectra)?;
    if bytes.len() != REAL * count {
        return Err(StoreError::Spectra);
    }
    let number = |index: usize| f64::from_be_bytes(std::array::from_fn(|place| bytes[place * count + index]));
    let mut next = 0;
    let mut lines = lengths.iter().map(|length| {
        let line: Vec<f64> = (next..next + *length as usize).map(number).collect();
        next += line.len();
        line
    });
    let mut line = || lines.next().ok_or(StoreError::Spectra);
    let engine_orders = line()?;
    let mut spectra = SpeedSpectra { engine_orders, sensors: Vec::with_capacity(sensors.len()) };
    for (sensor, waves) in sensors {
        let amplitude = line()?;
        let nodal_diameters = match waves {
            Waves::Own(count) => (0..count).map(|_| line()).collect::<Result<_, _>>()?,
            Waves::Of(before) => {
                let before = spectra.sensors.get(before as usize).ok_or(StoreError::Spectra)?;
                before.nodal_diameters.clone()
            }
        };
        spectra.sensors.push(SensorSpectrum { sensor: sensor.into(), amplitude, nodal_diameters });
    }
    Ok(spectra)
}

/// Spectra as earlier versions stored them, without packing.
#[derive(Debug, Serialize, Deserialize)]
struct Unpacked {
    engine_orders: Vec<f64>,
    sensors: Vec<(StoredSensor, Vec<f64>, Vec<Vec<f64>>)>,
}

/// Reads spectra that an earlier version stored without packing.
pub(super) fn read_unpacked(bytes: &[u8]) -> Result<SpeedSpectra, StoreError> {
    let Unpacked { engine_orders, sensors } = postcard::from_bytes(bytes)?;
    let spectrum = |(sensor, amplitude, nodal_diameters): (StoredSensor, _, _)| SensorSpectrum {
        sensor: sensor.into(),
        amplitude,
        nodal_diameters,
    };
    Ok(SpeedSpectra { engine_orders, sensors: sensors.into_iter().map(spectrum).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::request::{Component, Sensor};
    use crate::store::testing::stores;

    /// Spectra of `sensors`, which decay over the engine orders as those of a tip do; waves by contact node.
    fn spectra(sensors: &[(u32, u32)]) -> SpeedSpectra {
        let bins = 481;
        let line = |seed: u32| -> Vec<f64> {
            (0..bins)
                .map(|bin| (f64::from(seed * 7 + bin * bin) * 0.37).sin().abs() * 1e-3 / f64::from(1 + bin))
                .collect()
        };
        let sensor = |&(contact_node, sector): &(u32, u32)| SensorSpectrum {
            sensor: Sensor::at_contact(contact_node, sector, Component::Radial),
            amplitude: line(100 * contact_node + sector),
            nodal_diameters: (0..8).map(|i| line(1000 * (contact_node + 1) + i)).collect(),
        };
        SpeedSpectra {
            engine_orders: (0..bins).map(|bin| f64::from(bin) / 20.0).collect(),
            sensors: sensors.iter().map(sensor).collect(),
        }
    }

    fn bits(spectra: &SpeedSpectra) -> Vec<u64> {
        let of =
            |s: &SensorSpectrum| [vec![s.amplitude.clone()], s.nodal_diameters.clone()].concat().concat();
        let lines = spectra.sensors.iter().flat_map(of);
        spectra.engine_orders.iter().copied().chain(lines).map(f64::to_bits).collect()
    }

    #[test]
    fn what_is_packed_comes_back_to_the_bit_in_less_room() {
        let mut odd = spectra(&[(0, 0), (3, 0)]);
        odd.sensors[0].amplitude[7] = -0.0;
        odd.sensors[0].nodal_diameters[2][9] = f64::from_bits(1);
        odd.sensors[1].nodal_diameters.truncate(1);
        let none = SpeedSpectra { engine_orders: vec![], sensors: vec![] };
        for (written, share) in
            [(odd, 0.95), (spectra(&[(0, 0), (1, 2), (0, 5), (1, 2), (0, 1)]), 0.45), (none, 1.0)]
        {
            let (packed, unpacked) = pack(&written).unwrap();
            assert_eq!(unpacked, 8 * bits(&written).len() as u64);
            assert!(packed.len() <= (share * unpacked as f64) as usize + 8, "{} of {unpacked}", packed.len());
            let read = unpack(&packed).unwrap();
            assert_eq!(read, written);
            assert_eq!(bits(&read), bits(&written));
        }
    }

    #[tokio::test]
    async fn spectra_of_an_earlier_version_are_read_as_they_were_written() {
        for store in stores().await {
            let (job, written) = (crate::store::jobs::JobId::new(), spectra(&[(0, 0), (0, 1)]));
            sqlx::query(
                "insert into jobs (id, kind, status, model, modes_per_speed, facts, request, speeds, created_at, updated_at)
                 values ($1, 'sweep', 'running', 'm', 20, '{}', '{}', 2, 'a', 'a')",
            )
            .bind(job.to_string())
            .execute(&store.writer)
            .await
            .unwrap();
            let (packed, unpacked) = pack(&written).unwrap();
            let unpacked_then = Unpacked {
                engine_orders: written.engine_orders.clone(),
                sensors: (written.sensors.iter())
                    .map(|s| {
                        (StoredSensor::of(&s.sensor).unwrap(), s.amplitude.clone(), s.nodal_diameters.clone())
                    })
                    .collect(),
            };
            for (speed, bytes, unpacked) in
                [(0, postcard::to_stdvec(&unpacked_then).unwrap(), None), (1, packed, Some(unpacked as i64))]
            {
                sqlx::query(
                    "insert into speed_results (job, speed, status, point, spectra, unpacked_bytes, created_at)
                     values ($1, $2, 'completed', '{}', $3, $4, 'a')",
                )
                .bind(job.to_string())
                .bind(speed)
                .bind(bytes)
                .bind(unpacked)
                .execute(&store.writer)
                .await
                .unwrap();
            }
            for speed in [0, 1] {
                let row = |read: &SpeedSpectra| {
                    assert_eq!(read, &written);
                    Some(Vec::new())
                };
                assert_eq!(store.map_row(job, speed, row).await.unwrap(), Some(Vec::new()));
            }
            assert!(store.largest_spectra(job).await.unwrap() >= unpacked);
        }
    }

    #[test]
    fn waves_that_differ_in_a_bit_are_kept_apart() {
        let mut written = spectra(&[(0, 0), (0, 1)]);
        written.sensors[0].nodal_diameters[1][3] = 0.0;
        written.sensors[1].nodal_diameters[1][3] = -0.0;
        assert_eq!(bits(&unpack(&pack(&written).unwrap().0).unwrap()), bits(&written));
    }

    #[test]
    fn damaged_spectra_are_refused() {
        let (packed, _) = pack(&spectra(&[(0, 0), (0, 1)])).unwrap();
        for end in 0..packed.len() {
            assert!(unpack(&packed[..end]).is_err(), "{end}");
        }
        // A changed byte gives an error or other numbers, never a panic.
        for place in 0..packed.len().min(400) {
            let mut damaged = packed.clone();
            damaged[place] ^= 0x55;
            let _ = unpack(&damaged);
        }
    }
}
