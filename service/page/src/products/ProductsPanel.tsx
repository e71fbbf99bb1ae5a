// What can be made of a finished fit: asked for, followed, looked at and kept.
import { useState } from "preact/hooks";
import type { Product, ProductKind, Remark } from "../api/types";
import { isActive } from "../fit/watch";
import { messages } from "../messages";
import { Downloads } from "../result/Downloads";
import { usePictureOf } from "../result/files";
import { Choice } from "../ui/Choice";
import { ProblemNote } from "../ui/ProblemNote";
import { remarked } from "../ui/answered";
import { FIRST_WISHES, KINDS } from "./kinds";
import { useProducts } from "./products";

interface Props {
  readonly fitId: string;
  readonly hasLight: boolean;
  /** The id of what is shown large; null while it is the body itself. */
  readonly onStage: string | null;
  /** Shows a body that can be turned. */
  readonly onShow: (product: Product) => void;
}

const OFFERED = Object.keys(KINDS) as ProductKind[];

export function ProductsPanel({ fitId, hasLight, onStage, onShow }: Props) {
  const { products: words } = messages;
  const { list, isAsking, problem, make } = useProducts(fitId, (product) => hasBody(product) && onShow(product));
  const [kind, setKind] = useState<ProductKind>(OFFERED[0]!);
  const [wishes, wish] = useState(FIRST_WISHES);
  const { Options, lacks, part, request } = KINDS[kind];
  const lack = lacks?.(wishes) ?? null;
  return (
    <section class="section" aria-labelledby="products-title">
      <h2 id="products-title">{words.title}</h2>
      <Choice name="product" legend={words.what} quiet options={OFFERED.map((value) => ({ value, label: words.kinds[value].label }))} value={kind} onChange={setKind} />
      <p class="fine">{words.kinds[kind].help}</p>
      {Options && <Options hasLight={hasLight} wishes={wishes} onWish={(changed) => wish({ ...wishes, ...changed })} />}
      <button class="button" type="button" disabled={isAsking || lack !== null} onClick={() => void make(request(wishes), part?.(wishes) ?? null)}>
        {words.kinds[kind].make}
      </button>
      {lack && <p class="fine">{lack}</p>}
      {problem && <ProblemNote problem={problem} />}
      <ul class="products">
        {list.map((each) => (
          <ProductCard key={each.id} product={each} isOnStage={onStage === each.id} onShow={() => onShow(each)} />
        ))}
      </ul>
    </section>
  );
}

function hasBody({ kind, links }: Product): boolean {
  const { body } = KINDS[kind];
  return body !== undefined && (body.file in links.files || (body.still ?? "") in links.files);
}

/** One thing made of a fit: where it stands, what there is to know of it, the way to the stage, its files. */
function ProductCard({ product, isOnStage, onShow }: { product: Product; isOnStage: boolean; onShow: () => void }) {
  const { products: words } = messages;
  const { kind, links, problem, progress, result, state } = product;
  const { picture = "", told } = KINDS[kind];
  const url = usePictureOf(links, picture, state === "succeeded");
  const { label } = words.kinds[kind];
  return (
    <li class={isOnStage ? "is-on-stage" : ""} data-kind={kind} data-state={state}>
      <h3>{label}</h3>
      {isActive(product) && <progress class="bar" max={1} value={progress} aria-label={words.progress(label)} />}
      {problem && <ProblemNote problem={problem} />}
      {warningsOf(result).map((remark) => (
        <p class="note" key={remark.code + remark.reason}>
          {remarked(remark)}
        </p>
      ))}
      {result && told?.(result)}
      {url && <img class="product-picture" src={url} alt={label} />}
      {hasBody(product) && (
        <button class="button is-small" type="button" aria-pressed={isOnStage} onClick={onShow}>
          {words.turn}
        </button>
      )}
      <Downloads files={links.files} />
    </li>
  );
}

function warningsOf(result: Product["result"]): readonly Remark[] {
  return result && "warnings" in result ? result.warnings : [];
}
