// What came out: to look at on the left, to read on the right.
import { useEffect, useRef, useState } from "preact/hooks";
import type { Fit, FitResult, Product } from "../api/types";
import { openAgain } from "../draft/open";
import type { Picture } from "../draft/picture";
import { LimbList, goToLimb, openList } from "../flip/LimbList";
import { PreviewBar } from "../flip/PreviewBar";
import { areAllEmpty, isTurnedLimb } from "../flip/flips";
import type { TurnedLimb } from "../flip/flips";
import { useFlips } from "../flip/useFlips";
import { THUMBNAIL_PX, amend } from "../history/store";
import { messages } from "../messages";
import { viewTitles } from "../messages/viewNames";
import { START_ADDRESS, go } from "../route";
import { useSkin } from "../products/skin";
import { useEscape } from "../ui/escape";
import { later } from "../ui/later";
import { ProblemNote } from "../ui/ProblemNote";
import { Actions } from "./Actions";
import { Downloads } from "./Downloads";
import { Figures } from "./Figures";
import { Loading } from "./Loading";
import { Look } from "./Look";
import type { Shown } from "./Look";
import { Measures, rowOf } from "./Measures";
import { ForExperts } from "./ForExperts";
import { MoreNotes, Quality } from "./Notes";
import { Withheld } from "./Withheld";
import { measureAnyway } from "./again";
import { useResultFiles } from "./files";
import type { Note } from "./remarks";
import { isReliable as reliable } from "./quality";
import type { Snapshot } from "../viewer/DerivedCanvas";

// What can be made of a result is loaded after the result.
const ProductsPanel = later(() => import("../products/ProductsPanel").then((loaded) => loaded.ProductsPanel), null);
const ProductStage = later(() => import("../products/ProductStage").then((loaded) => loaded.ProductStage), null);

const NO_VIEWS: FitResult["views"] = [];

export function ResultView({ fit, pictures }: { fit: Fit; pictures: readonly Picture[] }) {
  const { result: words } = messages;
  const [wanted, want] = useState(0);
  const { result, files, loaded, problem } = useResultFiles(fit, wanted);
  const [pointedAt, pointAt] = useState<string | null>(null);
  const [shown, show] = useState<string | null>(null);
  const [looked, lookAt] = useState<Shown | null>(null);
  const [product, setProduct] = useState<Product | null>(null);
  const [sought, seek] = useState<TurnedLimb | null>(null);
  const number = files?.number ?? wanted;
  const views = result?.views ?? NO_VIEWS;
  const view = views[number];
  const isReliable = result === null || reliable(result);
  // A body that does not fit is judged over its picture.
  const skin = useSkin(fit.id, result?.verdict === "plausible");
  const onStage = looked ?? (!isReliable ? "picture" : skin.state === "none" ? "canonical" : "skin");
  const picture = pictures[number] ?? null;
  const turning = useFlips(views, number);
  const waist = result?.measurements.find(({ name }) => name === "waist_girth_smallest");
  useEffect(() => {
    // A fit opened by its link is in the history once its pictures are there.
    if (waist && picture) amend(fit.id, { waistCm: waist.value });
  }, [waist, picture]);
  const stage = useRef<HTMLDivElement>(null);
  const hasResult = result !== null;
  useEffect(() => {
    // Along with the bodies, not after them; if it fails, the canvas says so.
    if (hasResult) import("../viewer/BodyScene").catch(() => undefined);
  }, [hasResult]);
  useEffect(() => {
    // Its picture may have to be there first.
    if (!sought || number !== wanted) return;
    goToLimb(sought);
    seek(null);
  }, [sought, number]);
  // Where picture and text are stacked the stage may be out of sight.
  const toStage = () => stage.current?.scrollIntoView({ block: "nearest" });
  useEscape([
    [product !== null, () => setProduct(null)],
    [!areAllEmpty(turning.all), turning.takeBack],
    [shown !== null, () => show(null)],
  ]);
  const correct = picture ? (of: number) => void openAgain(fit, of, pictures) : null;
  const sayWhich = (limbs: readonly string[], of: number) => {
    const limb = limbs.find(isTurnedLimb);
    if (!limb) return correct?.(of);
    want(of);
    // Upright, all limbs hang down.
    lookAt("picture");
    seek(limb);
  };
  const act = ({ deed, limbs, number: of }: Note) => {
    if (deed === "another") go(START_ADDRESS);
    else if (deed === "limbs") sayWhich(limbs, of ?? 0);
    else correct?.(of ?? 0);
  };
  if (problem) {
    return (
      <main class="ended">
        <h1>{words.notShown}</h1>
        <ProblemNote problem={problem} />
      </main>
    );
  }
  const flipOnBody = (limb: TurnedLimb) => {
    openList();
    turning.flip(limb);
  };
  return (
    <main class="bench is-result" aria-busy={files === null || number !== wanted} data-fit={fit.id}>
      <header class={`result-head ${result ? "" : "is-coming"}`}>
        {result ? (
          <Quality result={result} onAct={picture && act} />
        ) : (
          <>
            <h1 class="title">{words.body}</h1>
            <p class="fine">{words.loading}</p>
          </>
        )}
        {result && result.measurements.length > 0 && <Figures measurements={result.measurements} reliable={isReliable} />}
      </header>
      <div class="bench-stage" ref={stage}>
        {product && <ProductStage product={product} skin={skin.path} onBack={() => setProduct(null)} />}
        {result && files && picture ? (
          <Look
            fit={fit}
            result={result}
            files={files}
            picture={picture}
            chosen={wanted}
            onChoose={want}
            hidden={product !== null}
            shown={onStage}
            onShow={lookAt}
            skin={skin}
            onColour={(take) => remembered(fit.id, take)}
            turning={turning}
            onFlip={flipOnBody}
            measure={pointedAt ?? shown}
            onPoint={pointAt}
            onMeasure={(name) => {
              show(shown === name ? null : name);
              document.getElementById(rowOf(name))?.scrollIntoView({ block: "center" });
            }}
          />
        ) : (
          !product && <Loading picture={picture} loaded={loaded} />
        )}
      </div>
      <div class="panel">
        <div class="panel-scroll">
          {result && <MoreNotes result={result} onAct={picture && act} onAdjust={correct} />}
          {result && result.measurements.length === 0 && <Withheld onAnyway={() => measureAnyway(fit)} />}
          {result && result.measurements.length > 0 && (
            <Measures
              measurements={result.measurements}
              reliable={isReliable}
              pointedAt={pointedAt ?? shown}
              onPoint={pointAt}
              onShow={(name) => {
                show(shown === name ? null : name);
                lookAt("canonical");
                setProduct(null);
                toStage();
              }}
            />
          )}
          {view && (
            <LimbList
              view={view}
              title={views.length > 1 ? viewTitles(views)[number]! : null}
              flips={turning.flips}
              pointedAt={turning.pointedAt}
              onPoint={turning.point}
              onFlip={(limb) => {
                // Upright, all limbs hang down.
                if (onStage !== "picture") lookAt("turned");
                setProduct(null);
                turning.flip(limb);
                toStage();
              }}
            />
          )}
          {result && (
            <ProductsPanel
              fitId={fit.id}
              hasLight={views[0]!.light !== null}
              onStage={product?.id ?? null}
              onShow={(made) => {
                setProduct(made);
                toStage();
              }}
            />
          )}
          {result && <ForExperts result={result} />}
          {result && (
            <details class="section fold-section">
              <summary>
                <h2>{messages.files.title}</h2>
              </summary>
              <Downloads files={filesOf(fit, result, skin.path)} sizes={new Map(result.files.map(({ name, size }) => [name, size]))} />
            </details>
          )}
        </div>
        {areAllEmpty(turning.all) ? (
          <Actions fit={fit} pictures={pictures} />
        ) : (
          <PreviewBar fit={fit} views={views} flips={turning.all} onTakeBack={turning.takeBack} />
        )}
      </div>
    </main>
  );
}

/** In the history a fit is known by its body. */
function remembered(id: string, take: Snapshot): void {
  const seen = take(THUMBNAIL_PX);
  if (seen) amend(id, { thumbnail: seen.toDataURL("image/jpeg", 0.7) });
}

/** Those of the result, with the table that is written when it is asked for, and the body in its skin. */
function filesOf({ links }: Fit, { measurements }: FitResult, skin: string | null): Readonly<Record<string, string>> {
  return {
    ...links.files,
    ...(measurements.length > 0 ? { "measurements.csv": `${links.self}/files/measurements.csv` } : {}),
    ...(skin ? { "body_textured.glb": skin } : {}),
  };
}
