// What there is to say of what was made: warnings, and what its kind tells.
import { useEffect, useState } from "preact/hooks";
import { getDerivationResult } from "../api/calls";
import type { Derivation, DerivationResult } from "../api/types";
import { entries } from "../history/store";
import { kindOf } from "./kinds";

export function DerivationSummary({ made }: { made: Derivation }) {
  const result = useResultOf(made);
  if (result === null) return null;
  const warnings = "warnings" in result ? result.warnings : [];
  return (
    <>
      {warnings.map(({ code, message }) => (
        <p class="note" key={code + message}>
          {withNames(message)}
        </p>
      ))}
      {kindOf(result.kind)?.told?.(result)}
    </>
  );
}

/** The result of a derivation that has succeeded; null until it is there. */
function useResultOf(made: Derivation): DerivationResult | null {
  const [result, setResult] = useState<DerivationResult | null>(null);
  useEffect(() => {
    let gone = false;
    getDerivationResult(made).then(
      (found) => gone || setResult(found),
      () => undefined,
    );
    return () => {
      gone = true;
    };
  }, [made.id]);
  return result;
}

/** Fits by the names this browser knows them by. */
function withNames(message: string): string {
  return entries.value.reduce((text, { id, name }) => text.replaceAll(id, `“${name}”`), message);
}
