// What was made of a fit, large: its name, what must be known of it first, and the way back to the body.
import { useState } from "preact/hooks";
import type { Derivation, NamedMotion } from "../api/types";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";
import { Icon } from "../ui/Icon";
import { DerivedCanvas } from "../viewer/DerivedCanvas";
import { DerivationWarnings } from "./DerivationSummary";
import { MotionChoice } from "./kinds/animation";
import { kindLabel, kindOf } from "./kinds";
import { ProductPicture } from "./ProductPicture";
import { useDerivationResult } from "./derivationResult";
import { viewsOf } from "./views";

interface Props {
  readonly made: Derivation;
  readonly onBack: () => void;
  /** The motion that is to be shown in its place, while it is made. */
  readonly motion: NamedMotion | null;
  readonly onMotion: (motion: NamedMotion) => void;
}

export function ProductStage({ made, onBack, motion, onMotion }: Props) {
  const { derived } = messages;
  const views = viewsOf(made);
  const result = useDerivationResult(made);
  const [file, choose] = useState(views[0]!.file);
  const view = views.find((each) => each.file === file) ?? views[0]!;
  const turns = kindOf(made.kind)?.turns;
  return (
    <section class="look" aria-label={kindLabel(made.kind)}>
      <div class="look-bar is-product">
        <button class="button is-small" type="button" onClick={onBack}>
          <Icon name="back" />
          {derived.back}
        </button>
        <b class="grow">{kindLabel(made.kind)}</b>
        {views.length > 1 && (
          <Choice
            name="product-view"
            legend={derived.view}
            quiet
            options={views.map((each) => ({ value: each.file, label: each.label }))}
            value={view.file}
            onChange={choose}
          />
        )}
      </div>
      {result && <DerivationWarnings of={result} />}
      {result?.kind === "animation" && (
        <div class="look-bar is-product">
          <MotionChoice name="motion-shown" value={motion ?? result.motion ?? null} onChange={onMotion} />
          {motion && (
            <p class="fine" role="status">
              {derived.animation.making(derived.animation.motions[motion])}
            </p>
          )}
        </div>
      )}
      {view.picture ? (
        <ProductPicture key={view.file} made={made} shows={view.picture} />
      ) : (
        <div class="look-room">
          <div class="look-free">
            <DerivedCanvas key={made.id} path={made.links.artifacts![view.file]!} label={turns!.label()} />
          </div>
          <p class="look-hint fine">{messages.look.hint}</p>
        </div>
      )}
    </section>
  );
}
