// The body in colour, upright with its tapes, or over its picture; what experts look at is folded.
import { useSignal } from "@preact/signals";
import { useState } from "preact/hooks";
import type { Fit, FitResult } from "../api/types";
import type { Picture } from "../draft/picture";
import { facingsOf, isEmpty } from "../flip/flips";
import type { TurnedLimb } from "../flip/flips";
import type { Turning } from "../flip/useFlips";
import { hoverWords } from "../flip/words";
import { percent } from "../messages/figures";
import { messages } from "../messages";
import { viewLabels } from "../messages/viewNames";
import type { Skin } from "../products/skin";
import { Choice } from "../ui/Choice";
import { IS_TOUCHED } from "../ui/narrow";
import { Slider } from "../ui/Slider";
import { BodyCanvas } from "../viewer/BodyCanvas";
import type { Placement } from "../viewer/BodyScene";
import { DerivedCanvas } from "../viewer/DerivedCanvas";
import type { Snapshot } from "../viewer/DerivedCanvas";
import type { GlbBody } from "../viewer/glb";
import { SideView } from "../viewer/SideView";
import { SURFACES } from "../viewer/surface";
import type { Surface } from "../viewer/surface";
import type { TapeEnds } from "../viewer/Tapes";
import type { Side } from "../viewer/Turntable";
import { Coloured } from "./Coloured";
import { FromSides } from "./FromSides";
import { TapeLabels } from "./TapeLabels";
import { WhatIfBar } from "./WhatIfBar";
import { nameOfView, usePictureOf } from "./files";
import type { ResultFiles } from "./files";

const POSES = ["canonical", "turned"] as const;
const OPACITIES = { least: 0, most: 1, step: 0.01 } as const;

/** What is on the stage: the body in one of its places, or its skin. */
export type Shown = Placement | "skin";

interface Props {
  readonly fit: Fit;
  readonly result: FitResult;
  readonly files: ResultFiles;
  /** That of the files. */
  readonly picture: Picture;
  /** The number of the picture that was chosen; it is shown once the body in it has come. */
  readonly chosen: number;
  readonly onChoose: (number: number) => void;
  /** While something else is on the stage: what was chosen here stays chosen. */
  readonly hidden: boolean;
  readonly shown: Shown;
  readonly onShow: (shown: Shown) => void;
  readonly skin: Skin;
  /** The body in colour is seen. */
  readonly onColour: (take: Snapshot) => void;
  readonly turning: Turning;
  readonly onFlip: (limb: TurnedLimb) => void;
  readonly measure: string | null;
  readonly onPoint: (name: string | null) => void;
  readonly onMeasure: (name: string) => void;
}

export function Look(props: Props) {
  const { fit, result, files, picture, chosen, onChoose, hidden, shown, onShow, skin, onColour, turning, onFlip, measure, onPoint, onMeasure } = props;
  const { number } = files;
  const { limbs, look, products } = messages;
  const { flips, pointedAt } = turning;
  const isSkin = shown === "skin";
  const placement = isSkin ? "canonical" : shown;
  const [surface, setSurface] = useState<Surface>("clay");
  const [opacity, setOpacity] = useState(0.85);
  const [lines, setLines] = useState(false);
  const [failed, setFailed] = useState(false);
  const [isOut, setOut] = useState(false);
  const [from, setFrom] = useState<{ readonly side: Side } | null>(null);
  const [other, setOther] = useState<GlbBody | null>(null);
  const ends = useSignal<readonly TapeEnds[]>([]);
  const surfaces: readonly Surface[] = files.posed.light === null ? ["clay"] : SURFACES;
  const over = placement === "picture";
  const turns = !isSkin && placement !== "canonical";
  const found = pointedAt && facingsOf(result.views[number]!)[pointedAt];
  const overlay = usePictureOf(fit.links, nameOfView(number, "overlay.png"), (lines || failed) && over);
  const views = [
    ...(skin.state === "none" ? [] : [{ value: "skin" as const, ...look.views.skin }]),
    { value: "body", ...look.views.body },
    { value: "picture", ...look.views.picture },
  ] as const;
  return (
    <div class="look" hidden={hidden} style={{ "--ratio": String(picture.width / picture.height) }}>
      <div class="look-bar">
        <Choice
          name="view"
          legend={look.view}
          quiet
          options={views}
          value={isSkin || over ? shown : "body"}
          onChange={(value) => onShow(value === "body" ? "canonical" : value)}
        />
        {shown !== "canonical" && !isSkin && result.views.length > 1 && (
          <Choice
            name="picture"
            legend={look.whichPicture}
            quiet
            options={viewLabels(result.views).map((label, at) => ({ value: String(at), label }))}
            value={String(chosen)}
            onChange={(at) => onChoose(Number(at))}
          />
        )}
        {over ? (
          <Slider label={look.body} named={look.opacity} range={OPACITIES} value={opacity} text={percent(opacity)} onInput={setOpacity} />
        ) : (
          <FromSides onLook={setFrom} />
        )}
      </div>
      <div class="look-room">
        <div class={over ? "look-picture" : "look-free"} hidden={isSkin}>
          {over && <img src={overlay ?? picture.url} alt={look.picture} />}
          {failed ? (
            <p class="note is-problem" role="alert">
              {look.noWebgl}
            </p>
          ) : (
            <BodyCanvas
              posed={files.posed}
              canonical={files.canonical}
              tapes={files.tapes}
              marked={measure}
              placement={placement}
              surface={surface}
              opacity={over ? opacity : 1}
              from={from}
              onTapes={(found) => (ends.value = found)}
              other={other}
              flips={flips}
              limb={pointedAt}
              onPointLimb={turning.point}
              onFlip={onFlip}
              onFailure={() => setFailed(true)}
            />
          )}
          {placement === "canonical" && !failed && (
            <TapeLabels ends={ends} measurements={result.measurements} marked={measure} hasSkin={skin.path !== null} onPoint={onPoint} onShow={onMeasure} />
          )}
        </div>
        {isSkin && (
          <Coloured
            skin={skin}
            files={files}
            picture={picture}
            from={from}
            isOut={isOut}
            onOut={(take) => {
              setOut(true);
              onColour(take);
            }}
          />
        )}
        {shown === "canonical" && skin.path && (
          <button class="look-beside" type="button" aria-label={look.showSkin} onClick={() => onShow("skin")}>
            <DerivedCanvas path={skin.path} label={products.texture.turned} like={files} turns small />
          </button>
        )}
        {over && !failed && <SideView posed={files.posed} canonical={files.canonical} flips={flips} />}
        {turns && !isEmpty(flips) && <p class="look-badge">{limbs.badge}</p>}
        {turns && pointedAt && found && (
          <p class="look-limb" aria-hidden="true">
            {hoverWords(pointedAt, found, flips)}
          </p>
        )}
        {!over && <p class="look-hint fine">{IS_TOUCHED ? look.hint.touch : look.hint.mouse}</p>}
      </div>
      {shown === "canonical" && files.canonical && result.measurements.length > 0 && <WhatIfBar result={result} upright={files.canonical} onBody={setOther} />}
      {!isSkin && (
        <details class="look-experts">
          <summary>{look.experts}</summary>
          <div class="look-bar">
            {!over && (
              <Choice name="placement" legend={look.pose} quiet options={POSES.map((value) => ({ value, ...look.poses[value] }))} value={placement} onChange={onShow} />
            )}
            <Choice
              name="surface"
              legend={look.surface}
              quiet
              options={surfaces.map((value) => ({ value, ...look.surfaces[value] }))}
              value={surface}
              onChange={setSurface}
            />
            {over && (
              <label class="check">
                <input
                  type="checkbox"
                  checked={lines}
                  onChange={(event) => {
                    setLines(event.currentTarget.checked);
                    if (event.currentTarget.checked) setOpacity(0);
                  }}
                />
                {look.outline}
              </label>
            )}
          </div>
        </details>
      )}
    </div>
  );
}
