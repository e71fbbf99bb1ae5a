// The body in motion.
import { measured, seconds } from "../../messages/figures";
import { messages } from "../../messages/language";
import { FileChoice } from "../FileChoice";
import type { Kind, OptionProps } from "./kind";

interface AnimationWishes {
  /** A BVH file; without one the body walks. */
  readonly motion: File | null;
}

/** What the service says a motion comes from: results have no code for it. */
const SHIPPED_WALK = "the walk that ships with the package";
const NAMED_JOINTS = "BVH with the names of ";

export const FIRST_ANIMATION: AnimationWishes = { motion: null };

export const animation: Kind<AnimationWishes> = {
  request: () => ({ kind: "animation" }),
  part: ({ motion }) => motion && { name: "bvh", file: motion },
  Options: MotionChoice,
  pictures: [{ file: "animation.webp", still: "animation.png", alt: () => words().pictured }],
  told: (result) => {
    if (result.kind !== "animation") return null;
    const length = seconds(result.frames * result.frame_time_s, 1);
    return <p class="fine">{words().told(sourceOf(result.source), length, measured(result.travelled_m, "meter", 1))}</p>;
  },
};

function words() {
  return messages.value.derived.animation;
}

function sourceOf(source: string): string {
  if (source.startsWith(NAMED_JOINTS)) return words().namedJoints(source.slice(NAMED_JOINTS.length));
  return source === SHIPPED_WALK ? words().shippedWalk : source;
}

function MotionChoice({ wishes: { motion }, onWish }: OptionProps<AnimationWishes>) {
  return (
    <div class="row">
      <FileChoice
        label={motion ? words().another : words().choose}
        accept=".bvh"
        onChoose={(file) => onWish({ motion: file })}
      />
      {motion && (
        <button class="button is-small" type="button" onClick={() => onWish({ motion: null })}>
          {words().walk}
        </button>
      )}
      <span class="fine grow">
        {motion ? words().moves(motion.name) : words().walks}
      </span>
    </div>
  );
}
