// A result as a site gets it.
import type { Result } from "../api/fits";

export function resultFor(id: string, { measurements, verdict, warnings }: Pick<Result, "measurements" | "verdict" | "warnings">): Maquette.Result {
  return {
    scan_id: id,
    measurements: measurements.map(({ name, value, unit, low, high }) => ({ name, value, unit, low, high })),
    verdict,
    warnings: warnings.map(({ code, message }) => ({ code, message })),
  };
}
