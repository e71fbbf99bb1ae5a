// The body of a product, large, and the way back to the fit's own.
import type { Product } from "../api/types";
import { messages } from "../messages";
import { Icon } from "../ui/Icon";
import { IS_TOUCHED } from "../ui/narrow";
import { DerivedCanvas } from "../viewer/DerivedCanvas";
import { KINDS } from "./kinds";

export function ProductStage({ product: { id, kind, links }, skin, onBack }: { product: Product; skin: string | null; onBack: () => void }) {
  const { look, products: words } = messages;
  const body = KINDS[kind].body!;
  return (
    <section class="look" aria-label={words.kinds[kind].label}>
      <div class="look-bar">
        <button class="button is-small" type="button" onClick={onBack}>
          <Icon name="back" />
          {words.back}
        </button>
        <b class="grow">{words.kinds[kind].label}</b>
      </div>
      <div class="look-room">
        <div class="look-free">
          <DerivedCanvas key={id} path={links.files[body.file] ?? links.files[body.still!]!} skin={skin} label={body.label} />
        </div>
        <p class="look-hint fine">{IS_TOUCHED ? look.hint.touch : look.hint.mouse}</p>
      </div>
    </section>
  );
}
