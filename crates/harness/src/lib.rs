//! The comparison harness: baselines, drift, order, reports.
