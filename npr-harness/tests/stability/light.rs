//! Limits of bands and tones of light.
