"""The program `linkwright` of a runner. It draws the images of reviews small, because they take most of the time.

The images themselves are tested in `tests/review`.
"""

from linkwright.cli import main
from linkwright.review.drawings import images, scene_images

SIZE = (80, 60)

if __name__ == "__main__":
    images._SIZE = scene_images._SIZE = SIZE
    raise SystemExit(main())
