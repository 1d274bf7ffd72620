//! From histories to engineering results: spectra, nodal diameters, settling, maps and critical speeds (§9).
