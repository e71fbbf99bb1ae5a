// How a fit ended, as a person reads it.
import type { FittedView, Result } from "../api/fits";
import { plainly } from "../measure/plainly";
import { wordFor } from "../messages/words";
import { percent } from "../messages/figures";
import { messages } from "../messages";
import { answered } from "../ui/answered";

/** Whether the picture contradicts that a person was measured. */
export function isContradicted({ verdict }: Pick<FittedView, "verdict">): boolean {
  return verdict !== "plausible";
}

type Headed = Pick<Result, "verdict"> & { readonly views: readonly Pick<FittedView, "outcome">[] };

export function headingOf({ verdict, views }: Headed): string {
  const { result: words } = messages;
  const isPoor = views.some(({ outcome }) => outcome === "poor_fit");
  return wordFor(words.verdicts, verdict) ?? (isPoor ? words.poorFit : words.body);
}

/** What an outcome other than convergence means, and what to do; null where the service says it better. */
export function explanationOf(view: Pick<FittedView, "outcome" | "verdict" | "silhouette_overlap">, isOfSeveral: boolean): string | null {
  const { result: words } = messages;
  if (!isContradicted(view)) return wordFor(words.explained, view.outcome);
  if (isOfSeveral) return plainly("verdicts", view.verdict);
  const said = answered("verdicts", view.verdict);
  return said && `${said} ${words.overlapIs(percent(view.silhouette_overlap))}`;
}
