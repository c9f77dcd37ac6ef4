//! Tests of stages and changes.
