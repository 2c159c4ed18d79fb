//! Guards of paths: roulette, ends, absorption.
