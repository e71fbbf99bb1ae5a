// What can be made of a finished fit: asked for, followed, looked at and kept.
import { useEffect, useState } from "preact/hooks";
import { getDerivationResult } from "../api/calls";
import type { Fit } from "../api/fits";
import type { Derivation, NamedMotion } from "../api/types";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";
import { ProblemNote } from "../ui/ProblemNote";
import { FIRST_WISHES, KINDS, type OfferedKind, kindLabel } from "./kinds";
import { useDerivations } from "./follow";
import { DerivationCard } from "./DerivationCard";
import { viewsOf } from "./views";

interface Props {
  readonly parent: Fit;
  /** The job of the skin, which the body shows itself: it is not listed. */
  readonly skin: string | null;
  readonly hasLight: boolean;
  /** The id of what is shown large; null while it is the body itself. */
  readonly onStage: string | null;
  /** Shows large what can be looked at. */
  readonly onShow: (made: Derivation | null) => void;
  /** The motion that is wanted on the stage; null once it is there, or cannot be had. */
  readonly motion: NamedMotion | null;
  readonly onMotionEnded: () => void;
}

/** In the order they are offered; `report` is chosen first. */
const OFFERED = Object.keys(KINDS) as OfferedKind[];

export function DerivedPanel({ parent, skin, hasLight, onStage, onShow, motion, onMotionEnded }: Props) {
  const { derived } = messages;
  const { list, problem, start, make, retry, erase } = useDerivations(parent, (made) => viewsOf(made).length > 0 && onShow(made));
  const [kind, setKind] = useState<OfferedKind>("report");
  const [wishes, wish] = useState(FIRST_WISHES);
  const [asking, setAsking] = useState(false);
  useEffect(() => {
    if (!motion) return;
    void madeBefore(list, motion)
      .then((before) => (before ? onShow(before) : make({ kind: "animation", motion })))
      .finally(onMotionEnded);
  }, [motion]);
  const chosen = KINDS[kind];
  const lack = chosen.lacks?.(wishes) ?? null;
  const { Options } = chosen;
  return (
    <section class="section" aria-labelledby="derived-title">
      <h2 id="derived-title">{derived.title}</h2>
      <Choice
        name="derivation"
        legend={derived.what}
        quiet
        options={OFFERED.map((value) => ({ value, label: kindLabel(value) }))}
        value={kind}
        onChange={setKind}
      />
      <p class="fine">{derived.kinds[kind].help}</p>
      {Options && <Options parent={parent} hasLight={hasLight} wishes={wishes} onWish={(changed) => wish({ ...wishes, ...changed })} />}
      <button
        class="button"
        type="button"
        disabled={asking || lack !== null}
        onClick={() => {
          setAsking(true);
          void start(chosen.request(wishes), chosen.part?.(wishes) ?? null).finally(() => setAsking(false));
        }}
      >
        {derived.kinds[kind].make}
      </button>
      {lack && <p class="fine">{lack}</p>}
      {problem && <ProblemNote problem={problem} />}
      <ul class="derived">
        {list.filter(({ id }) => id !== skin).map((each) => (
          <DerivationCard
            key={each.id}
            made={each}
            isOnStage={onStage === each.id}
            onShow={() => onShow(each)}
            onRetry={() => void retry(each)}
            onMake={(asked) => void start(asked, null)}
            onErase={() => {
              if (onStage === each.id) onShow(null);
              void erase(each);
            }}
          />
        ))}
      </ul>
    </section>
  );
}

/** The animation of this motion, if there is one. */
async function madeBefore(list: readonly Derivation[], motion: NamedMotion): Promise<Derivation | null> {
  for (const each of list) {
    if (each.kind !== "animation" || each.state !== "succeeded") continue;
    const result = await getDerivationResult(each).catch(() => null);
    if (result?.kind === "animation" && result.motion === motion) return each;
  }
  return null;
}
