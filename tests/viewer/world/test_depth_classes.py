import numpy as np

from viewer.world import DEPTH_CLASS_COLOURS, DEPTH_CLASS_LIMITS, depth_class, depth_class_labels


def test_a_depth_belongs_to_the_class_that_it_reaches() -> None:
    depths = [0.0, 0.149, 0.15, 0.3, 0.6, 0.76, 1.5, 2.0, 50.0]

    assert depth_class(depths).tolist() == [0, 0, 1, 2, 3, 4, 5, 6, 6]


def test_every_class_has_a_colour_and_a_label() -> None:
    assert len(DEPTH_CLASS_COLOURS) == len(depth_class_labels()) == len(DEPTH_CLASS_LIMITS) + 1
    assert depth_class_labels()[0] == "< 0.15"
    assert depth_class_labels()[-1] == "> 2"


def test_deeper_is_always_darker() -> None:
    lightness = np.array(DEPTH_CLASS_COLOURS) @ [0.2126, 0.7152, 0.0722]

    assert (np.diff(lightness) < -10.0).all()


def test_neighbouring_classes_stay_apart_for_people_without_red_or_green_cones() -> None:
    # Vienot, Brettel and Mollon 1999, in linear light.
    linear = (np.array(DEPTH_CLASS_COLOURS) / 255.0) ** 2.2
    protan = np.array([[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]])
    deutan = np.array([[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]])
    for matrix in (protan, deutan):
        seen = np.clip(linear @ matrix.T, 0.0, 1.0) ** (1 / 2.2) * 255.0
        assert (np.linalg.norm(np.diff(seen, axis=0), axis=1) > 25.0).all()
