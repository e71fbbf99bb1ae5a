// The result of a derivation that has succeeded.
import { useEffect, useState } from "preact/hooks";
import { getDerivationResult } from "../api/calls";
import type { Derivation, DerivationResult } from "../api/types";

/** Null until it is there, and of what has not succeeded. */
export function useDerivationResult(made: Derivation): DerivationResult | null {
  const [result, setResult] = useState<DerivationResult | null>(null);
  const done = made.state === "succeeded";
  useEffect(() => {
    if (!done) return undefined;
    let gone = false;
    getDerivationResult(made).then(
      (found) => gone || setResult(found),
      () => undefined,
    );
    return () => {
      gone = true;
    };
  }, [made.id, done]);
  return result;
}
