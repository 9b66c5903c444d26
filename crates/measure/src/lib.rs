//! Proof that strategies agree, and the timing protocol with its statistics; prints nothing.
