//! Limits of lines from edges, fins and hulls.
