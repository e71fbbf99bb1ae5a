// What can be made of a finished fit: asked for, followed, looked at and kept.
import { useState } from "preact/hooks";
import type { Job } from "../api/types";
import { Choice } from "../ui/Choice";
import { ProblemNote } from "../ui/ProblemNote";
import { FIRST_WISHES, KINDS, type OfferedKind, kindLabel } from "./kinds";
import { useDerivations } from "./follow";
import { DerivationCard } from "./DerivationCard";

interface Props {
  readonly fit: Job;
  readonly hasLight: boolean;
}

export function DerivedPanel({ fit, hasLight }: Props) {
  const { list, problem, start, retry, erase } = useDerivations(fit);
  const [kind, setKind] = useState<OfferedKind>("report");
  const [wishes, wish] = useState(FIRST_WISHES);
  const [asking, setAsking] = useState(false);
  const chosen = KINDS[kind];
  const lack = chosen.lacks?.(wishes) ?? null;
  const { Options } = chosen;
  return (
    <section class="section" aria-labelledby="derived-title">
      <h2 id="derived-title">Make something of it</h2>
      <Choice
        name="derivation"
        legend="What to make"
        quiet
        options={(Object.keys(KINDS) as OfferedKind[]).map((value) => ({ value, label: kindLabel(value) }))}
        value={kind}
        onChange={setKind}
      />
      <p class="fine">{chosen.help}</p>
      {Options && <Options fit={fit} hasLight={hasLight} wishes={wishes} onWish={(changed) => wish({ ...wishes, ...changed })} />}
      <button
        class="button"
        type="button"
        disabled={asking || lack !== null}
        title={lack ?? undefined}
        onClick={() => {
          setAsking(true);
          void start(chosen.request(wishes), chosen.part?.(wishes) ?? null).finally(() => setAsking(false));
        }}
      >
        Make the {chosen.label.toLowerCase()}
      </button>
      {problem && <ProblemNote problem={problem} />}
      <ul class="derived">
        {list.map((each) => (
          <DerivationCard key={each.id} made={each} onRetry={() => void retry(each)} onErase={() => void erase(each)} />
        ))}
      </ul>
    </section>
  );
}
