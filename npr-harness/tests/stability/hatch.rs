//! Limits of hatching.
