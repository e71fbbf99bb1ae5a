// What there is to say of what was made: warnings, which come first, and what its kind tells.
import type { DerivationResult } from "../api/types";
import { entries } from "../history/store";
import { answered } from "../ui/answered";

/** Of what contradicts a result altogether. */
const CONTRADICTIONS: ReadonlySet<string> = new Set(["different-people"]);

export function DerivationWarnings({ of: result }: { of: DerivationResult }) {
  const all = "warnings" in result ? result.warnings : [];
  // What the page says itself it says once, of however many columns of a chart the service tells it.
  const warnings = all.filter(({ code }, at) => answered("warnings", code) === null || all.findIndex((each) => each.code === code) === at);
  return (
    <>
      {warnings.map(({ code, message }) => (
        <p class={CONTRADICTIONS.has(code) ? "note is-problem" : "note"} key={code + message}>
          {answered("warnings", code) ?? withNames(message)}
        </p>
      ))}
    </>
  );
}

/** Fits by the names this browser knows them by. */
function withNames(message: string): string {
  return entries.value.reduce((text, { id, name }) => text.replaceAll(id, `“${name}”`), message);
}
