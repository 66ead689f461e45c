"""Table III of the 2008 study beside the values the study itself prints, and what P*1 hangs on. Standard library only."""
import math

TABLE_3 = {"0": (0.0237, 0.469, 0.349, 0.91, 0.271), "0.005": (0.0316, 0.515, 0.194, 1.08, 0.9)}
PHI_MAX = {"0": 0.7808, "0.005": 0.7745}
# P*, Φ, ± and where: at P*0 the mean is at least that at 0.01, for Φ does not fall on loading.
PRINTED = {
    "0": [(0.0237, 0.472, 0.008, "Table II, a lower bound")],
    "0.005": [(0.0316, 0.524, 0.008, "Table II, a lower bound"), (0.178, 0.6305, None, "figure 3, one sample"),
              (0.237, 0.6305 * 1.032, None, "the same and Table IV, if one sample"), (13.335, 0.774, 0.001, "text"),
              (13.335, 0.7778, None, "figure 4, the sample of figure 3")],
}


def curve(p, p0, phi_0, slope, alpha, p1):
    return 1 / (1 / phi_0 - slope * math.log(p / p0 * (-math.expm1(-(p1 / p) ** alpha)) ** (1 / alpha)))


print("| μ_R/a | P* | Φ printed | (9) with Table III | difference | where |\n|---|---|---|---|---|---|")
for mu_r, rows in PRINTED.items():
    for p, phi, scatter, where in rows:
        fitted = curve(p, *TABLE_3[mu_r])
        told = f"{phi:.4f}" + (f" ± {scatter}" if scatter else "")
        print(f"| {mu_r} | {p:g} | {told} | {fitted:.4f} | {phi - fitted:+.4f} | {where} |")
for mu_r, error in (("0", 0.019), ("0.005", 0.004)):
    p0, phi_0, slope, _, p1 = TABLE_3[mu_r]
    log = (1 / phi_0 - 1 / PHI_MAX[mu_r]) / slope
    by_phi = 0.008 / 3 / phi_0**2 / slope
    lifted = p0 * math.exp((1 / PRINTED[mu_r][0][1] - 1 / PHI_MAX[mu_r]) / slope)
    print(f"\nμ_R/a = {mu_r}: P*1 = P*0 exp[(1/Φ0 − 1/Φmax)/λ] = {p0 * math.exp(log):.3f} (printed {p1}); its error from λ alone "
          f"{p1 * log * error / slope:.3f}, from Φ0 (0.008/√9) {p1 * by_phi:.3f}; with Φ0 the Φ(0.01) of Table II {lifted:.3f}")
