//! What drives a sample.

mod servo_walls;

pub use servo_walls::ServoWalls;
