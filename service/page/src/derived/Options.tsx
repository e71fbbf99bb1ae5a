// What can be chosen of the kind that is to be made.
import type { Job, NamedPose, TextureColours, TextureSize } from "../api/types";
import { Choice } from "../ui/Choice";
import { DEGREES, FACTORS, POSES, TEXTURE_SIZES } from "./kinds";
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
      <label class="button is-small">
        {motion ? "Another BVH file" : "Choose a BVH file"}
        <input
          class="unseen"
          type="file"
          accept=".bvh"
          onChange={(event) => {
            const file = event.currentTarget.files?.[0];
            event.currentTarget.value = "";
            if (file) onWish({ motion: file });
          }}
        />
      </label>
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

function TextureChoice({ hasLight, wishes, onWish }: Props) {
  return (
    <>
      {hasLight ? (
        <Choice<TextureColours>
          name="colours"
          legend="Colours"
          options={[
            { value: "picture", label: "As photographed", title: "With the light of the picture" },
            { value: "albedo", label: "Without the light", title: "The albedo: to be lit anew" },
          ]}
          value={wishes.colours}
          onChange={(colours) => onWish({ colours })}
        />
      ) : (
        <p class="fine">With the light of the picture: only a fit with shading can take it out.</p>
      )}
      <div class="field">
        <label for="texture-size">Size</label>
        <select
          id="texture-size"
          value={wishes.size}
          onChange={(event) => onWish({ size: Number(event.currentTarget.value) as TextureSize })}
        >
          {TEXTURE_SIZES.map((size) => (
            <option key={size} value={size}>
              {size} × {size}
            </option>
          ))}
        </select>
      </div>
    </>
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
