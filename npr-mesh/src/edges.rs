//! Unique edges.
