//! What every edgeloc board runs, whatever its pins.
#![no_std]
