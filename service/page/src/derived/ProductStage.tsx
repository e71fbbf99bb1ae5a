// What was made of a fit, large: its name, what must be known of it first, and the way back to the body.
import { useState } from "preact/hooks";
import type { Derivation } from "../api/types";
import { messages } from "../messages/language";
import { Choice } from "../ui/Choice";
import { Icon } from "../ui/Icon";
import { DerivedCanvas } from "../viewer/DerivedCanvas";
import { DerivationWarnings } from "./DerivationSummary";
import { kindLabel, kindOf } from "./kinds";
import { ProductPicture } from "./ProductPicture";
import { useDerivationResult } from "./derivationResult";
import { viewsOf } from "./views";

export function ProductStage({ made, onBack }: { made: Derivation; onBack: () => void }) {
  const { derived } = messages.value;
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
      {view.picture ? (
        <ProductPicture key={view.file} made={made} shows={view.picture} />
      ) : (
        <div class="look-room">
          <div class="look-free">
            <DerivedCanvas path={made.links.artifacts![view.file]!} label={turns!.label()} />
          </div>
          <p class="look-hint fine">{messages.value.look.hint}</p>
        </div>
      )}
    </section>
  );
}
