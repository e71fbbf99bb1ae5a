// What came out: to look at on the left, to read on the right.
import { useEffect, useRef, useState } from "preact/hooks";
import type { Fit, Result } from "../api/fits";
import type { Derivation, NamedMotion } from "../api/types";
import { DerivedPanel } from "../derived/DerivedPanelLater";
import { ProductStage } from "../derived/ProductStageLater";
import { useSkin } from "../derived/skin";
import type { Picture } from "../draft/picture";
import { LimbList, goToLimb, openList } from "../flip/LimbList";
import { PreviewBar } from "../flip/PreviewBar";
import { areAllEmpty, isTurnedLimb } from "../flip/flips";
import type { TurnedLimb } from "../flip/flips";
import { useFlips } from "../flip/useFlips";
import { messages } from "../messages";
import { openAgain } from "../panel/open";
import { useEscape } from "../ui/escape";
import { ProblemNote } from "../ui/ProblemNote";
import { Actions } from "./Actions";
import { Downloads } from "./Downloads";
import { Facts, ForExperts, Quality } from "./Facts";
import { Figures } from "./Figures";
import { OfPictures } from "./OfPictures";
import { useResultFiles } from "./files";
import { Keep } from "./Keep";
import { Loading } from "./Loading";
import { Look } from "./Look";
import type { Shown } from "./Look";
import { Measures, rowOf } from "./Measures";
import { Withheld } from "./Withheld";
import { changeAgain, measureAnyway } from "./again";
import { gradeOf } from "./grade";
import { headingOf, isContradicted } from "./outcome";

const NO_VIEWS: Result["views"] = [];

export function ResultView({ fit, pictures }: { fit: Fit; pictures: readonly Picture[] }) {
  const { result: words } = messages;
  const [wanted, want] = useState(0);
  const { result, files, loaded, problem } = useResultFiles(fit, wanted);
  const [pointedAt, pointAt] = useState<string | null>(null);
  const [shown, show] = useState<string | null>(null);
  const [looked, lookAt] = useState<Shown | null>(null);
  const [product, setProduct] = useState<Derivation | null>(null);
  const [motion, wishMotion] = useState<NamedMotion | null>(null);
  const [sought, seek] = useState<TurnedLimb | null>(null);
  const number = files?.number ?? wanted;
  const views = result?.views ?? NO_VIEWS;
  const view = views[number];
  const isReliable = views.every((each) => gradeOf(each) !== "poor");
  // A body that does not fit is judged over its picture.
  const onStage = looked ?? (isReliable ? "canonical" : "picture");
  const skin = useSkin(fit, result !== null && !isContradicted(result));
  const picture = pictures[number] ?? null;
  const turning = useFlips(views, number);
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
  const correct = picture ? (of: number) => void openAgain(fit, of, pictures[of]!) : null;
  const sayWhich = (limbs: readonly string[], of: number) => {
    const limb = limbs.find(isTurnedLimb);
    if (!limb) return void (correct ? correct(of) : changeAgain(fit, pictures));
    want(of);
    // Upright, all limbs hang down.
    lookAt("picture");
    seek(limb);
  };
  if (problem) {
    return (
      <main class="ended">
        <h1>{words.notShown}</h1>
        <ProblemNote problem={problem} />
      </main>
    );
  }
  // Earlier versions told none of several pictures.
  const knowsLimbs = view !== undefined && view.limb_facing.length > 0;
  const flipOnBody = (limb: TurnedLimb) => {
    openList();
    turning.flip(limb);
  };
  const facts = result && { fit, result, onSayWhich: picture && sayWhich, onCorrect: correct };
  return (
    <main class="bench is-result" aria-busy={files === null || number !== wanted} data-fit={fit.id}>
      <header class="result-head">
        <div class="result-title">
          <h1 class="title">{result ? headingOf(result) : words.body}</h1>
          {result && <Keep fit={fit} hasTable={result.measurements.length > 0} skin={skin.path} />}
        </div>
        {result ? <Quality result={result} /> : <p class="fine">{words.loading}</p>}
        {result && result.measurements.length > 0 && <Figures measurements={result.measurements} reliable={isReliable} />}
      </header>
      <div class="bench-stage" ref={stage}>
        {product && <ProductStage key={product.kind} made={product} onBack={() => setProduct(null)} motion={motion} onMotion={wishMotion} />}
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
            turning={turning}
            onFlip={knowsLimbs ? flipOnBody : null}
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
          {facts && <Facts {...facts} />}
          {facts && views.length > 1 && <OfPictures {...facts} />}
          {result && result.measurements.length === 0 && <Withheld onAnyway={() => measureAnyway(fit)} />}
          {result && result.measurements.length > 0 && (
            <Measures
              measurements={result.measurements}
              before={result.outlined}
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
          {view && knowsLimbs && (
            <LimbList
              view={view}
              isOfSeveral={views.length > 1}
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
            <DerivedPanel
              parent={fit}
              skin={skin.id}
              hasLight={views[0]!.light !== null}
              onStage={product?.id ?? null}
              motion={motion}
              onMotionEnded={() => wishMotion(null)}
              onShow={(made) => {
                setProduct(made);
                if (made) toStage();
              }}
            />
          )}
          {result && <ForExperts result={result} />}
          {result && <Downloads fit={fit} result={result} />}
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
