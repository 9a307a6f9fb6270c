//! A sheet that falls broadside through still air with quadratic drag ½ρC_d v².

/// A falling sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BroadsideFall {
    /// Gravitational acceleration, m/s².
    pub gravity: f64,
    /// Area density, kg/m².
    pub density: f64,
    /// Density of the air times drag coefficient ρ C_d, kg/m³.
    pub drag: f64,
}

impl BroadsideFall {
    /// Terminal speed, m/s: √(2σg/(ρC_d)).
    #[must_use]
    pub fn terminal_speed(&self) -> f64 {
        (2.0 * self.density * self.gravity / self.drag).sqrt()
    }

    /// Speed `t` seconds after the release, m/s.
    #[must_use]
    pub fn speed(&self, t: f64) -> f64 {
        let terminal = self.terminal_speed();
        terminal * (self.gravity * t / terminal).tanh()
    }

    /// Depth `t` seconds after the release, m.
    #[must_use]
    pub fn depth(&self, t: f64) -> f64 {
        let terminal = self.terminal_speed();
        terminal * terminal / self.gravity * (self.gravity * t / terminal).cosh().ln()
    }

    /// Step in seconds beyond which explicit drag at this speed reverses the motion: 2σ/(ρ C_d v).
    #[must_use]
    pub fn reversing_step(&self, speed: f64) -> f64 {
        2.0 * self.density / (self.drag * speed)
    }

    /// Speed after `h` seconds of drag alone, exact: v/(1 + ρC_d|v|h/2σ), m/s.
    #[must_use]
    pub fn dragged(&self, speed: f64, h: f64) -> f64 {
        speed / (1.0 + h / self.reversing_step(speed.abs()))
    }

    /// Speed after `steps` steps of `h` seconds of drag alone in the form that Gauss–Seidel has for air, m/s:
    /// v ← v − a v/(1 + a min(a, 1)) with a = ρC_d|v|h/2σ. It is exact to second order for held cloth, and for
    /// moving cloth nearly explicit.
    #[must_use]
    pub fn dragged_in_steps(&self, speed: f64, h: f64, steps: usize) -> f64 {
        (0..steps).fold(speed, |speed, _| {
            let a = h / self.reversing_step(speed.abs());
            speed - a * speed / (1.0 + a * a.min(1.0))
        })
    }
}
