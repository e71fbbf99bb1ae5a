// A result as a site gets it.
import type { Result } from "../api/fits";
import { WITHIN_95 } from "../result/reading";

export function resultFor(id: string, { measurements, verdict, warnings }: Pick<Result, "measurements" | "verdict" | "warnings">): Maquette.Result {
  return {
    scan_id: id,
    measurements: measurements.map(({ name, value, unit, standard_error: error }) => {
      const isKnown = error !== null && error !== undefined;
      return { name, value, unit, low: isKnown ? value - WITHIN_95 * error : null, high: isKnown ? value + WITHIN_95 * error : null };
    }),
    verdict,
    warnings: warnings.map(({ code, message }) => ({ code, message })),
  };
}
