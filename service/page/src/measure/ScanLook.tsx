// The body over its pictures side by side, or upright to be turned.
import { useSignal } from "@preact/signals";
import { useState } from "preact/hooks";
import type { Scan, ScanResult } from "../api/types";
import type { Picture } from "../draft/picture";
import { messages } from "../messages/language";
import { FromSides } from "../result/FromSides";
import { LoadingNote } from "../result/Loading";
import { TapeLabels } from "../result/TapeLabels";
import { usePictureOf } from "../result/files";
import type { FilesOf } from "../result/files";
import { Choice } from "../ui/Choice";
import { BodyCanvas } from "../viewer/BodyCanvas";
import type { TapeEnds } from "../viewer/Tapes";
import type { Side } from "../viewer/Turntable";
import { pictureOf, viewLabel } from "./views";
import type { ViewName } from "./views";

const SHOWN = ["pictures", "upright"] as const;
export type Shown = (typeof SHOWN)[number];

interface Props {
  readonly scan: Scan;
  readonly result: ScanResult;
  /** Null until the bodies are there; the pictures do without. */
  readonly files: FilesOf<ScanResult> | null;
  readonly loaded: number;
  /** As they were taken, in the order of the views. */
  readonly pictures: readonly Picture[];
  readonly shown: Shown;
  readonly onShow: (shown: Shown) => void;
  readonly measure: string | null;
  readonly onPoint: (name: string | null) => void;
  readonly onMeasure: (name: string) => void;
}

export function ScanLook({ scan, result, files, loaded, pictures, shown, onShow, measure, onPoint, onMeasure }: Props) {
  const { look, measure: { result: words } } = messages.value;
  const [front] = pictures;
  const [failed, setFailed] = useState(false);
  const [from, setFrom] = useState<{ readonly side: Side } | null>(null);
  const ends = useSignal<readonly TapeEnds[]>([]);
  return (
    <div class={`look is-scan ${shown === "pictures" ? "is-pictures" : ""}`}>
      <div class="look-bar">
        <Choice name="scan-shown" legend={look.view} quiet options={SHOWN.map((value) => ({ value, ...words.shown[value] }))} value={shown} onChange={onShow} />
        {shown === "upright" && files && <FromSides onLook={setFrom} />}
      </div>
      {shown === "pictures" ? (
        <div class="overlays">
          {result.views.map(({ number, view }, i) => (
            <Overlay key={number} scan={scan} number={number} view={view} picture={pictures[i] ?? null} />
          ))}
          {!files && <LoadingNote loaded={loaded} />}
        </div>
      ) : !files || !front ? (
        <div class="look-room">
          <LoadingNote loaded={loaded} />
        </div>
      ) : (
        <div class="look-room">
          <div class="look-free">
            {failed ? (
              <p class="note is-problem" role="alert">
                {look.noWebgl}
              </p>
            ) : (
              <BodyCanvas
                posed={files.posed}
                outlined={null}
                body="SES"
                canonical={files.canonical}
                picture={front.element}
                tapes={files.tapes}
                marked={measure}
                placement="canonical"
                surface="clay"
                opacity={1}
                from={from}
                onTapes={(found) => (ends.value = found)}
                onFailure={() => setFailed(true)}
              />
            )}
            {!failed && <TapeLabels ends={ends} measurements={result.measurements} marked={measure} onPoint={onPoint} onShow={onMeasure} />}
          </div>
          <p class="look-hint fine">{look.hint}</p>
        </div>
      )}
    </div>
  );
}

interface OverlayProps {
  readonly scan: Scan;
  readonly number: number;
  readonly view: ViewName;
  /** Shown until the body over it is there. */
  readonly picture: Picture | null;
}

function Overlay({ scan, number, view, picture }: OverlayProps) {
  const { look, measure } = messages.value;
  const url = usePictureOf(scan, `overlay_${number}.png`, true);
  return (
    <figure class="overlay">
      {url ? (
        <img src={url} alt={measure.result.overlay(pictureOf(view))} data-shows={`overlay_${number}`} />
      ) : (
        picture && <img src={picture.url} alt={look.picture} />
      )}
      <figcaption>{viewLabel(view)}</figcaption>
    </figure>
  );
}
