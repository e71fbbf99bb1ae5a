// A person measured from the front and from the side: the pictures, the camera, and what came out.
import { plural } from "../figures";

export const measure = {
  title: "Measure a person",
  lead: "Two pictures, from the front and from the side, and a height.",
  noHeight: "The height is needed: pictures alone do not tell how large a body is.",
  weight: "If you know it, the weight makes measurements better.",
  noPictures: "No pictures at hand?",
  trySample: "Try the sample pair",
  leftOut: (count: number) =>
    `The scan has ${plural(count, { one: "one more picture", other: `${count} more pictures` })}. This screen takes one from the front and one from the side, and leaves out the rest.`,
  rules: {
    title: "For good measurements",
    list: [
      "Tight clothes or underwear, hair tied up, no shoes.",
      "The phone upright at the height of the belly, level, two to three metres away; stood on something or held by somebody.",
      "From head to feet in the picture, with some room around.",
      "Light from the camera’s side, and a wall of another colour than skin and clothes.",
      "Breathe out, stand relaxed, do not draw in the belly. Both pictures from the same place: turn yourself, not the camera.",
      "Pictures of the phone’s own camera, chosen as files, name their lens: then nothing has to be assumed.",
    ],
  },
  noDetector: {
    title: "This service cannot find the person by itself",
    why: "Its detector is not installed, so pictures are neither checked nor measured without clicks. Click the joints in the editor, which measures by one picture.",
    openFront: "Open the front picture there",
    toEditor: "To the editor",
  },
  /** Pictures by where they show the person from: as a label, and within a sentence without its article. */
  views: {
    front: { label: "Front", picture: "front picture" },
    side: { label: "Side", picture: "side picture" },
    back: { label: "Back", picture: "back picture" },
    other: { label: "Other", picture: "other picture" },
  },
  ofPicture: (picture: string) => `The ${picture}`,
  /** One of several pictures of the same kind. */
  viewNumber: (view: string, number: number) => `${view} ${number}`,
  place: {
    stances: {
      front: "Face the camera. Feet apart as wide as the shoulders, arms well away from the body.",
      side: "Turn to either side. Feet together, arms stretched forward, looking ahead.",
    },
    drawn: {
      front: "Drawn: a person from the front, arms and legs apart",
      side: "Drawn: a person from the side, legs together, arms stretched forward",
    },
    take: "Take a picture",
    takeAgain: "Take again",
    takeNamed: (picture: string) => `Take the ${picture}`,
    choose: "Choose a file",
    chooseOther: "Other file",
    chooseNamed: (picture: string) => `Choose a file: ${picture}`,
    looking: "Looking at the picture …",
    good: "Good to measure",
    /** Read out when a picture has been looked at. */
    told: (view: string, said: string) => `${view}: ${said}`,
  },
  findings: { blocks: "Take it again", harms: "Could be better" },
  unusable: "This picture cannot be measured",
  todo: {
    height: "Give the height",
    add: (picture: string) => `Add the ${picture}`,
    again: (picture: string) => `Take the ${picture} again`,
    noDetector: "Points cannot be proposed here",
  },
  submit: "Measure",
  anyway: {
    title: "Measure all the same?",
    ask: (pictures: readonly string[]) => `The ${pictures.join(" and the ")} should be taken again. Measure all the same?`,
    back: "Back",
  },
  camera: {
    label: (picture: string) => `Camera: ${picture}`,
    sees: "What the camera sees",
    taken: "Taken",
    chooseInstead: (picture: string) => `Choose a file instead: ${picture}`,
    countdown: "Countdown",
    useBack: "Use the back camera",
    useFront: "Use the front camera",
    stop: "Stop",
    takeIn: (seconds: string) => `Take it in ${seconds}`,
    troubles: {
      forbidden: "This page may not use the camera. Allow it in the browser’s settings, or choose a file.",
      none: "No camera was found. Choose a file instead.",
      used: "Something else uses the camera. Close that, or choose a file.",
      unusable: "The camera cannot be used here. Choose a file instead.",
      noPicture: "The camera gave no picture. Try again, or choose a file.",
    },
  },
  level: {
    level: "Level",
    left: "Turn the phone to the left",
    right: "Turn the phone to the right",
    down: "The camera looks up: tilt it down",
    up: "The camera looks down: tilt it up",
  },
  quality: {
    contradicted: "A picture does not show a person as it should: take it again.",
    differentPeople: "The pictures contradict each other: do not trust these measurements.",
    poor: "Poor: a picture should be taken again. See below.",
    fair: "Fair: the pictures could be better. See below.",
    good: "Good: nothing is wrong with the pictures, and they agree.",
    rarely: (share: string) => `Pictures of one person differ as much as these in only ${share} of cases. See that both show the same person, dressed alike.`,
    nearlyAlways: "Pictures of one person nearly always differ more than these.",
    often: (share: string) => `Pictures of one person differ as much as these in ${share} of cases.`,
  },
  /** How many of a picture's points nobody clicked. */
  proposed: {
    all: (picture: string) => `all of the ${picture}`,
    some: (count: number, picture: string) => `${count} of the ${picture}`,
  },
  /** In place of `answers`, for people who click nothing and can only take a picture again. */
  told: {
    faults: {
      "person-not-found": "Nobody was found in this picture. Have the whole person in it, upright, in good light and unhidden.",
      "points-too-close": "The person is too small in this picture. Go nearer.",
      "too-few-points": "Too little of the person is seen in this picture. Have the whole person in it, from head to feet.",
    },
    warnings: {
      "ambiguous-limb-facing": "By this picture an arm or a leg may as well point the other way. If you take it again, stand as the good pictures show.",
      "different-people": "The pictures seem to show different people. See that both show the same person, dressed alike.",
      "left-and-right-may-be-swapped": "Left and right may have been taken for each other. Take the picture again, turned as the good pictures show.",
      "low-silhouette-overlap": "The body covers little of the person in the picture. Take it again, before a wall of another colour.",
      "nobody-found": "Nobody was found in this picture. Have the whole person in it, upright, in good light and unhidden.",
      "other-view": "The person is turned otherwise than asked for. Take the picture again: facing the camera from the front, turned by a quarter from the side, and not mirrored.",
      "segmentation-doubtful": "The person could hardly be told from the background. Take the picture again, before a wall of another colour.",
      "several-people": "Several people are in this picture, and the largest is measured. Have nobody else in it.",
      "shoulders-and-hips-disagree": "Left and right may have been taken for each other. Take the picture again, turned as the good pictures show.",
    },
    verdicts: {
      implausible: "A body was found, but this picture contradicts it. Take it again: one person alone, whole, and standing as the good pictures show.",
      no_person: "No person is seen in this picture. Take it again, with the whole person in it, in good light and unhidden.",
    },
  },
} as const;
