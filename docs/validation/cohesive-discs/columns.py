"""Columns of states.csv and how their values are written."""
SCENE = ["n", "assembly", "mu_r", "seed"]
STATE = ["state", "branch", "leg", "p", "phi", "z", "z_plus", "z_minus", "z_zero", "z_distant", "z_star",
         "rattler_share", "x22", "mean_normal_force", "mean_normal_force_expected", "z2_ratio", "bulk", "shear",
         "bulk_voigt", "shear_voigt", "bulk_reuss", "stiffness_sign", "fractal_dimension", "correlation_length",
         "pore_radius", "contacts_kept", "contacts_lost", "contacts_gained", "converged", "sliding",
         "residual_force", "residual_moment", "residual_stress", "residual_kinetic", "steps", "time"]
RUN = ["scene_key", "kernel", "physics_version", "code_version"]


def short(value):
    return f"{value:.8g}" if isinstance(value, float) else "" if value is None else str(value)
