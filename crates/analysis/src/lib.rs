//! Collapse, fits, resampling: tables in, curves with uncertainties out.
