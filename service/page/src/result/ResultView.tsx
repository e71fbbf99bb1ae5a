// What came out: to look at on the left, to read on the right.
import { useEffect, useRef, useState } from "preact/hooks";
import type { Derivation, Job } from "../api/types";
import { DerivedPanel } from "../derived/DerivedPanelLater";
import { ProductStage } from "../derived/ProductStage";
import type { Picture } from "../draft/picture";
import { LimbList, goToLimb, openList } from "../flip/LimbList";
import { PreviewBar } from "../flip/PreviewBar";
import { isEmpty, isTurnedLimb } from "../flip/flips";
import { useFlips } from "../flip/useFlips";
import { messages } from "../messages/language";
import { openAgain } from "../panel/open";
import { useEscape } from "../ui/escape";
import { ProblemNote } from "../ui/ProblemNote";
import { Actions } from "./Actions";
import { Downloads } from "./Downloads";
import { Facts } from "./Facts";
import { useResultFiles } from "./files";
import { Keep } from "./Keep";
import { Loading } from "./Loading";
import { Look } from "./Look";
import { Measures, rowOf } from "./Measures";
import { Withheld } from "./Withheld";
import { measureAnyway } from "./again";
import { gradeOf } from "./grade";
import { headingOf } from "./outcome";
import { withoutShading } from "./reading";
import type { Placement } from "../viewer/BodyScene";

export function ResultView({ job, picture }: { job: Job; picture: Picture | null }) {
  const { result: words } = messages.value;
  const { result, files, loaded, problem } = useResultFiles(job);
  const [pointedAt, pointAt] = useState<string | null>(null);
  const [shown, show] = useState<string | null>(null);
  const [placement, setPlacement] = useState<Placement>("picture");
  const [product, setProduct] = useState<Derivation | null>(null);
  const turning = useFlips(result);
  const stage = useRef<HTMLDivElement>(null);
  const hasResult = result !== null;
  useEffect(() => {
    // Along with the bodies, not after them; if it fails, the canvas says so.
    if (hasResult) import("../viewer/BodyScene").catch(() => undefined);
  }, [hasResult]);
  // Where picture and text are stacked the stage may be out of sight.
  const toStage = () => stage.current?.scrollIntoView({ block: "nearest" });
  useEscape([
    [product !== null, () => setProduct(null)],
    [!isEmpty(turning.flips), turning.takeBack],
    [shown !== null, () => show(null)],
  ]);
  const sayWhich = (limbs: readonly string[]) => {
    const limb = limbs.find(isTurnedLimb);
    if (limb) goToLimb(limb);
    else void openAgain(picture!, job);
  };
  if (problem) {
    return (
      <main class="ended">
        <h1>{words.notShown}</h1>
        <ProblemNote problem={problem} />
      </main>
    );
  }
  return (
    <main class="bench is-result" aria-busy={files === null} data-fit={job.id}>
      <div class="bench-stage" ref={stage}>
        {product && <ProductStage key={product.id} made={product} onBack={() => setProduct(null)} />}
        {files && picture ? (
          <Look
            job={job}
            files={files}
            picture={picture}
            hidden={product !== null}
            placement={placement}
            onPlace={setPlacement}
            turning={turning}
            onFlip={(limb) => {
              openList();
              turning.flip(limb);
            }}
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
          <section class="section">
            <h1 class="title">{result ? headingOf(result) : words.body}</h1>
            {result ? <Facts job={job} result={result} onSayWhich={picture && sayWhich} /> : <p class="fine">{words.loading}</p>}
          </section>
          {result && (
            <LimbList
              result={result}
              flips={turning.flips}
              pointedAt={turning.pointedAt}
              onPoint={turning.point}
              onFlip={(limb) => {
                // Upright, all limbs hang down.
                if (placement === "canonical") setPlacement("turned");
                setProduct(null);
                turning.flip(limb);
                toStage();
              }}
            />
          )}
          {result && result.measurements.length === 0 && <Withheld onAnyway={picture && (() => measureAnyway(picture, job))} />}
          {result && result.measurements.length > 0 && (
            <Measures
              measurements={result.measurements}
              before={withoutShading(result)}
              reliable={gradeOf(result) !== "poor"}
              pointedAt={pointedAt ?? shown}
              onPoint={pointAt}
              onShow={(name) => {
                show(shown === name ? null : name);
                setPlacement("canonical");
                setProduct(null);
                toStage();
              }}
            />
          )}
          {result && <Keep job={job} hasTable={result.measurements.length > 0} />}
          {result && (
            <DerivedPanel
              parent={job}
              hasLight={result.light !== null}
              onStage={product?.id ?? null}
              onShow={(made) => {
                setProduct(made);
                if (made) toStage();
              }}
            />
          )}
          {result && <Downloads job={job} result={result} />}
        </div>
        {isEmpty(turning.flips) ? (
          <Actions job={job} picture={picture} />
        ) : (
          <PreviewBar job={job} picture={picture} flips={turning.flips} onTakeBack={turning.takeBack} />
        )}
      </div>
    </main>
  );
}
