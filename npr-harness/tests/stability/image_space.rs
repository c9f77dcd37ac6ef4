//! Limits of lines found in the image.
