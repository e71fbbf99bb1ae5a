// The body in motion.
import type { NamedMotion } from "../../api/types";
import { measured, seconds } from "../../messages/figures";
import { messages } from "../../messages";
import { Choice } from "../../ui/Choice";
import { FileChoice } from "../FileChoice";
import type { Kind, OptionProps } from "./kind";

interface AnimationWishes {
  readonly named: NamedMotion;
  /** A BVH file, which goes before the name. */
  readonly motion: File | null;
}

const MOTIONS: readonly NamedMotion[] = ["walk", "wave", "turn", "squat", "jumping_jack"];
/** What the service says a motion of a file comes from. */
const NAMED_JOINTS = "BVH with the names of ";
/** Who goes less far stays where they are. */
const ON_THE_SPOT_M = 0.1;

export const FIRST_ANIMATION: AnimationWishes = { named: "walk", motion: null };

export const animation: Kind<AnimationWishes> = {
  request: ({ named, motion }) => (motion ? { kind: "animation" } : { kind: "animation", motion: named }),
  part: ({ motion }) => motion && { name: "bvh", file: motion },
  Options: MotionOptions,
  turns: { file: "body_animated.glb", label: () => words().turned, first: true },
  pictures: [{ file: "animation.webp", still: "animation.png", alt: () => words().pictured, label: () => words().film }],
  told: (result) => {
    if (result.kind !== "animation") return null;
    const { motion, source } = result;
    const name = motion ? words().motions[motion] : sourceOf(source);
    const length = seconds(result.frames * result.frame_time_s, 1);
    const way = measured(result.travelled_m, "meter", 1);
    return <p class="fine">{result.travelled_m < ON_THE_SPOT_M ? words().told(name, length) : words().toldWithWay(name, length, way)}</p>;
  },
};

function words() {
  return messages.derived.animation;
}

function sourceOf(source: string): string {
  return source.startsWith(NAMED_JOINTS) ? words().namedJoints(source.slice(NAMED_JOINTS.length)) : source;
}

interface MotionProps {
  /** Of the radio buttons: it stands twice on the page. */
  readonly name: string;
  readonly value: NamedMotion | null;
  readonly onChange: (motion: NamedMotion) => void;
}

/** One of the motions that have names; none while a file tells it. */
export function MotionChoice(props: MotionProps) {
  const options = MOTIONS.map((value) => ({ value, label: words().motions[value] }));
  return <Choice legend={words().motion} quiet options={options} {...props} />;
}

function MotionOptions({ wishes: { named, motion }, onWish }: OptionProps<AnimationWishes>) {
  return (
    <>
      <MotionChoice name="motion" value={motion ? null : named} onChange={(named) => onWish({ named, motion: null })} />
      <div class="row">
        <FileChoice
          label={motion ? words().another : words().choose}
          accept=".bvh"
          onChoose={(file) => onWish({ motion: file })}
        />
        <span class="fine grow">
          {motion ? words().moves(motion.name) : words().files}
        </span>
      </div>
    </>
  );
}
