//! Limits of shadows.
