// What can be chosen of the kind that is to be made.
import type { Job, NamedPose, TextureColours, TextureSize } from "../api/types";
import { Choice } from "../ui/Choice";
import { LIMITS } from "../api/limits";
import { DEGREES, FACTORS, POSES } from "./kinds";
import type { Wishes } from "./kinds";
import { OtherFits } from "./OtherFits";

interface Props {
  readonly fit: Job;
  /** Whether the fit found the light, so that it can be taken out of the picture. */
  readonly hasLight: boolean;
  readonly wishes: Wishes;
  readonly onWish: (changed: Partial<Wishes>) => void;
}

/** By kind; a report is made without further questions. */
export const OPTIONS: Readonly<Record<string, (props: Props) => preact.JSX.Element>> = {
  figure: (props) => (
    <>
      <PoseChoice {...props} />
      <Slider
        label="Seen from"
        range={DEGREES}
        value={props.wishes.degrees}
        text={viewText(props.wishes.degrees)}
        onInput={(degrees) => props.onWish({ degrees })}
      />
    </>
  ),
  pose: PoseChoice,
  caricature: ({ wishes, onWish }) => (
    <Slider label="Times" range={FACTORS} value={wishes.factor} text={String(wishes.factor)} onInput={(factor) => onWish({ factor })} />
  ),
  animation: MotionChoice,
  texture: TextureChoice,
  combined: ({ fit, wishes, onWish }) => <OtherFits fit={fit} chosen={wishes.fits} onChoose={(fits) => onWish({ fits })} />,
};

function PoseChoice({ wishes, onWish }: Props) {
  return (
    <div class="field">
      <label for="pose">Pose</label>
      <select id="pose" value={wishes.pose} onChange={(event) => onWish({ pose: event.currentTarget.value as NamedPose })}>
        {POSES.map(({ value, label }) => (
          <option key={value} value={value}>
            {label}
          </option>
        ))}
      </select>
    </div>
  );
}

function MotionChoice({ wishes: { motion }, onWish }: Props) {
  return (
    <div class="row">
      <FileChoice
        label={motion ? "Another BVH file" : "Choose a BVH file"}
        accept=".bvh"
        onChoose={(file) => onWish({ motion: file })}
      />
      {motion && (
        <button class="button is-small" type="button" onClick={() => onWish({ motion: null })}>
          Let it walk
        </button>
      )}
      <span class="fine grow">
        {motion
          ? `It moves as ${motion.name} says.`
          : "Without a file it walks. Joints may be named as by CMU, Mixamo, Rokoko or Blender."}
      </span>
    </div>
  );
}

const PHOTOGRAPHED = { value: "picture", label: "As photographed", title: "With the light of the picture" } as const;
const UNLIT = { value: "albedo", label: "Without the light", title: "The albedo: to be lit anew" } as const;
const OWN = { value: "own", label: "My own", title: "A texture painted in the atlas’ layout" } as const;

function TextureChoice({ hasLight, wishes, onWish }: Props) {
  return (
    <>
      <Choice<TextureColours>
        name="colours"
        legend="Colours"
        options={hasLight ? [PHOTOGRAPHED, UNLIT, OWN] : [PHOTOGRAPHED, OWN]}
        value={wishes.colours}
        onChange={(colours) => onWish({ colours })}
      />
      {!hasLight && <p class="fine">Only a fit with shading can take the light out of the picture.</p>}
      {wishes.colours === "own" ? <OwnTexture wishes={wishes} onWish={onWish} /> : <TextureSide wishes={wishes} onWish={onWish} />}
    </>
  );
}

type Wished = Pick<Props, "wishes" | "onWish">;

function OwnTexture({ wishes: { texture }, onWish }: Wished) {
  return (
    <div class="row">
      <FileChoice
        label={texture ? "Another texture" : "Choose a texture"}
        accept="image/png,image/jpeg,image/webp"
        onChoose={(file) => onWish({ texture: file })}
      />
      <span class="fine grow">
        {texture
          ? `${texture.name} is laid on the body.`
          : "A square picture. Make a texture first: its atlas.png says where each part of the body lies."}
      </span>
    </div>
  );
}

function TextureSide({ wishes, onWish }: Wished) {
  return (
    <div class="field">
      <label for="texture-size">Size</label>
      <select
        id="texture-size"
        value={wishes.size}
        onChange={(event) => onWish({ size: Number(event.currentTarget.value) as TextureSize })}
      >
        {LIMITS.textureSizes.map((size) => (
          <option key={size} value={size}>
            {size} × {size}
          </option>
        ))}
      </select>
    </div>
  );
}

interface FileChoiceProps {
  readonly label: string;
  readonly accept: string;
  readonly onChoose: (file: File) => void;
}

function FileChoice({ label, accept, onChoose }: FileChoiceProps) {
  return (
    <label class="button is-small">
      {label}
      <input
        class="unseen"
        type="file"
        accept={accept}
        onChange={(event) => {
          const file = event.currentTarget.files?.[0];
          event.currentTarget.value = "";
          if (file) onChoose(file);
        }}
      />
    </label>
  );
}

interface SliderProps {
  readonly label: string;
  readonly range: { readonly least: number; readonly most: number; readonly step: number };
  readonly value: number;
  readonly text: string;
  readonly onInput: (value: number) => void;
}

function Slider({ label, range, value, text, onInput }: SliderProps) {
  return (
    <label class="slider">
      <span>{label}</span>
      <input
        type="range"
        min={range.least}
        max={range.most}
        step={range.step}
        value={value}
        aria-valuetext={text}
        onInput={(event) => onInput(Number(event.currentTarget.value))}
      />
      <output>{text}</output>
    </label>
  );
}

/** How far the onlooker has walked round the body, to the right of the picture. */
function viewText(degrees: number): string {
  if (degrees === 0) return "in front";
  if (Math.abs(degrees) === 180) return "behind";
  return `${Math.abs(degrees)}° ${degrees > 0 ? "right" : "left"}`;
}
