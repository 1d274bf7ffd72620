//! Arguments of imports: speeds with files, axes, units.

use std::path::PathBuf;

use crate::cli::speed::speed;
use crate::dynamics::sector::Units;
use crate::package::raw::Axis;

pub(super) fn speed_and_file(text: &str) -> Result<(f64, PathBuf), String> {
    let (at, job) = text.split_once('=').ok_or("expected SPEED=JOB, such as 2500=half")?;
    Ok((speed(at)?, PathBuf::from(job)))
}

pub(super) fn axis(text: &str) -> Result<Axis, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[a, b, c, d, e, f]) => Ok(Axis { origin: [a, b, c], direction: [d, e, f] }),
        _ => Err("expected six numbers x,y,z,dx,dy,dz".to_owned()),
    }
}

pub(super) fn units(text: &str) -> Result<Units, String> {
    let names: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
    let [length, force, time, mass]: [String; 4] =
        names.try_into().map_err(|_| "expected length,force,time,mass, such as mm,N,s,t")?;
    Ok(Units { length, force, time, mass })
}
