"""Bogie and vehicle built a second time, from bodies, springs and dampers at their places, in the code Exudyn.

Nothing of the model's equations is used: bodies are rigid in the plane, the car body in space, connectors act between
points of bodies, the pistons of the dampers are points without mass, and the wheel-rail contact is a force at each of
the four wheels. So a sign, an arm or a reaction that is wrong in the model shows here.
"""

from types import SimpleNamespace

import exudyn as exu
import numpy as np
import pytest
import scipy.linalg as sl
from exudyn.itemInterface import (
    MarkerBodyPosition,
    MarkerBodyRigid,
    MarkerNodePosition,
    NodePoint2D,
    NodeRigidBody2D,
    NodeRigidBodyRxyz,
    ObjectConnectorCartesianSpringDamper,
    ObjectConnectorTorsionalSpringDamper,
    ObjectGround,
    ObjectMassPoint2D,
    ObjectRigidBody,
    ObjectRigidBody2D,
    SensorNode,
)
from scipy.optimize import linear_sum_assignment

from yawdesign.hunting.eigenvalues import state_matrix
from yawdesign.vehicle.vehicle import Model

ENDS, SIDES = (1, -1), (1, -1)  # front and rear, left and right
X, Y = 0, 1


class Assembly:
    """A bogie in the plane: x forward, y to the left, yaw from x to y; only its car body stands still.

    `moving` are the coordinates that are looked at, `along` those of motions along the track, up and in pitch.
    """

    coupled = 0.0  # largest share of a stiffness between what is looked at and what is not

    def __init__(self, p, C_s):
        self.p = SimpleNamespace(**{k.rstrip("_"): v for k, v in p.items() if k != "lambda"}, conicity=p["lambda"])
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        self.ground = self.system.AddObject(ObjectGround())
        self.nodes, self.pistons = {}, []
        self.moving, self.along = [], []
        self.build(C_s)
        self.system.Assemble()

    def body(self, name, x, mass, inertia):
        node = self.system.AddNode(NodeRigidBody2D(referenceCoordinates=[x, 0, 0]))
        self.nodes[name] = node
        self.moving += [(node, 1), (node, 2)]
        self.along += [(node, 0)]
        return self.system.AddObject(ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node))

    def point(self, body, x, y, z=0):
        return self.system.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=[x, y, z]))

    def above(self, x, y, height):
        """Return the point of the car body at a place, so much below its centre of mass."""
        return self.point(self.ground, x, y)

    def piston(self, x, y):
        node = self.system.AddNode(NodePoint2D(referenceCoordinates=[x, y]))
        self.system.AddObject(ObjectMassPoint2D(mass=0.0, nodeNumber=node))
        self.pistons.append(node)
        return self.system.AddMarker(MarkerNodePosition(nodeNumber=node))

    def connect(self, first, second, stiffness=(0, 0), damping=(0, 0)):
        connector = ObjectConnectorCartesianSpringDamper(
            markerNumbers=[first, second], stiffness=[*stiffness, 0], damping=[*damping, 0]
        )
        self.system.AddObject(connector)

    def damper(self, first, second, place, along, joint, c):
        """Put a damper with a joint at both ends between two points that lie at the same place."""
        near, far = self.piston(*place), self.piston(*place)
        self.connect(first, near, (joint, joint))
        self.connect(near, far, damping=c * np.eye(2)[along])
        self.connect(far, second, (joint, joint))

    def build(self, C_s):
        self.bogie("", 0, C_s)

    def bogie(self, name, middle, C_s):
        p = self.p
        frame = self.body(f"b{name}", middle, p.M_b, p.J_b)
        for side in SIDES:
            at = self.above(middle, side * p.b_2, "h_s"), self.point(frame, 0, side * p.b_2)
            self.connect(*at, (p.K_2x / 2, p.K_2y / 2))
            at = (middle, side * p.b_3)
            self.damper(self.above(*at, ""), self.point(frame, 0, side * p.b_3), at, X, p.K_ds, C_s / 2)
        for number, end in enumerate(ENDS, start=1):
            at = (middle + end * p.b_0, 0)
            self.damper(self.above(*at, "h_t"), self.point(frame, end * p.b_0, 0), at, Y, p.K_dt, p.C_t / 2)
            self.wheelset(frame, f"{name}{number}", end * p.a, middle)
            self.motor(frame, f"{name}{number}", end * p.a_0, middle)
        return frame

    def wheelset(self, frame, name, x, middle):
        p = self.p
        wheelset = self.body(f"w{name}", middle + x, p.M_w, p.J_w)
        for side in SIDES:
            box = self.point(frame, x, side * p.b_1), self.point(wheelset, 0, side * p.b_1)
            self.connect(*box, (p.K_1x / 2, p.K_1y / 2))
            wheel = self.point(self.ground, middle + x, side * p.b), self.point(wheelset, 0, side * p.b)
            self.system.AddObject(
                ObjectConnectorCartesianSpringDamper(markerNumbers=list(wheel), springForceUserFunction=self.rail(side))
            )

    def motor(self, frame, name, x, middle):
        p = self.p
        motor = self.body(f"m{name}", middle + x, p.M_m, p.J_m)
        hangers = self.point(frame, x, 0), self.point(motor, 0, 0)
        self.connect(*hangers, (0, p.K_m))
        self.damper(*hangers, (middle + x, 0), Y, p.K_dm, p.C_m)
        ends = [
            self.system.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=place))
            for body, place in ((frame, [x, 0, 0]), (motor, [0, 0, 0]))
        ]
        self.system.AddObject(
            ObjectConnectorTorsionalSpringDamper(markerNumbers=ends, stiffness=p.K_mphi, damping=p.C_mphi)
        )

    def rail(self, side):
        """Return the force that holds a wheel: creep, and the normal force of half the axle load on a cone."""
        p = self.p

        def force(system, t, item, displacement, velocity, *unused):
            ahead, y = displacement[:2]
            yaw = -ahead / (side * p.b)
            radius = p.r + side * p.conicity * y  # a wheel that moves outwards rolls on a larger radius
            slip_x = (p.v + velocity[0] - p.v / p.r * radius) / p.v
            slip_y = velocity[1] / p.v - yaw
            inwards = p.W / 2 * p.conicity * (side + y / p.b)
            return [p.f_22 * slip_x, p.f_11 * slip_y + inwards, 0]

        return force

    def coordinate(self, node, component):
        return self.system.GetNodeODE2Index(node) + component

    def settings(self):
        settings = exu.SimulationSettings()
        for solver in (settings.staticSolver, settings.timeIntegration):
            solver.newton.numericalDifferentiation.relativeEpsilon = 1e-5
            solver.verboseMode = 0
        settings.solution.file.write = False
        return settings

    def eigenvalues(self):
        """Return the finite eigenvalues of lateral motion and yaw."""
        M, K, D = exu.ComputeLinearizedSystem(self.system, self.settings())
        moving = [self.coordinate(*place) for place in self.moving]
        pistons = [self.coordinate(node, c) for node in self.pistons for c in (0, 1)]
        own = np.array(moving + pistons)
        # Bodies do not move along the track: nothing but the two yaw dampers against each other would notice.
        along = [self.coordinate(*place) for place in self.along]
        for matrix in (K, D):
            assert np.abs(matrix[np.ix_(moving, along)]).max() <= self.coupled * np.abs(matrix).max()
        n, unit = len(moving), 1e7
        M, K, D = (matrix[np.ix_(own, own)] / unit for matrix in (M, K, D))
        # States: velocities of the bodies, then all positions. The rows of the pistons have no inertia.
        left = np.vstack([np.hstack([M[:n, :n], D[:n]]), np.hstack([np.zeros((len(pistons), n)), D[n:]])])
        left = np.vstack([left, np.hstack([np.zeros((n, n)), np.eye(n, len(own))])])
        right = np.vstack([np.hstack([np.zeros((len(own), n)), -K]), np.eye(n, n + len(own))])
        s = sl.eigvals(right, left, homogeneous_eigvals=True)
        finite = np.abs(s[1]) > 1e-9 * np.abs(s[0])
        return s[0, finite] / s[1, finite]

    def swing(self, name, offset, end, steps):
        """Return lateral displacement and yaw of all bodies over time, one wheelset being off the centre at first."""
        self.system.SetNodeParameter(self.nodes[name], "initialCoordinates", [0, offset, 0])
        sensors = {
            body: self.system.AddSensor(
                SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=exu.OutputVariableType.Coordinates)
            )
            for body, node in self.nodes.items()
        }
        self.system.Assemble()
        settings = self.settings()
        settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = end, steps
        settings.timeIntegration.generalizedAlpha.spectralRadius = 1
        settings.timeIntegration.generalizedAlpha.computeInitialAccelerations = False  # points without mass have none
        settings.timeIntegration.newton.useModifiedNewton = False
        settings.solution.sensors.writePeriod = end / 100
        self.system.SolveDynamic(settings)
        return {body: self.system.GetSensorStoredData(sensor) for body, sensor in sensors.items()}


class WholeVehicle(Assembly):
    """A car body that moves in space, on two bogies in the plane."""

    coupled = 1e-9  # the car body's are found by differences

    def build(self, C_s):
        p = self.p
        node = self.system.AddNode(NodeRigidBodyRxyz(referenceCoordinates=[0] * 6))
        inertia = [p.I_c, p.J_c, p.J_c, 0, 0, 0]  # roll, pitch, yaw
        self.car_body = self.system.AddObject(ObjectRigidBody(mass=p.M_c, inertia=inertia, nodeNumber=node))
        self.moving += [(node, 1), (node, 3), (node, 5)]
        self.along += [(node, 0), (node, 2), (node, 4)]
        for name, end in (("1", 1), ("2", -1)):
            frame = self.bogie(name, end * p.l_c, C_s)
            for side in SIDES:
                at = self.above(end * p.l_c, side * p.b_2, "h_s"), self.point(frame, 0, side * p.b_2)
                self.system.AddObject(
                    ObjectConnectorCartesianSpringDamper(
                        markerNumbers=list(at),
                        stiffness=[0, 0, p.K_2z],
                        damping=[0, 0, p.C_2z],
                        offset=[0, 0, p.h_s],
                    )
                )

    def above(self, x, y, height):
        return self.point(self.car_body, x, y, -getattr(self.p, height) if height else 0)


def expected_eigenvalues(p, C_s):
    """Return the eigenvalues of the model, with the two yaw dampers against each other."""
    return np.append(np.linalg.eigvals(state_matrix(Model().at(p, C_s=C_s))), -p["K_ds"] / C_s)


def largest_difference(found, expected):
    assert len(found) == len(expected)
    apart = np.abs(found[:, None] - expected) / np.maximum(1, np.abs(expected))
    return apart[linear_sum_assignment(apart)].max()


def random_reciprocal_bogies(table1, n, seed):
    """Return bogies with every parameter of Table I times or divided by up to 3, and C_s up to 10 MN s/m."""
    rng = np.random.default_rng(seed)
    for _ in range(n):
        p = {name: value * 3.0 ** rng.uniform(-1, 1) for name, value in table1.items()}
        yield {**p, "v": rng.uniform(150, 450) / 3.6}, 10 ** rng.uniform(4.5, 7)


def test_eigenvalues_of_random_bogies(table1):
    for p, C_s in random_reciprocal_bogies(table1, 50, seed=1):
        found = Assembly(p, C_s).eigenvalues()
        assert largest_difference(found, expected_eigenvalues(p, C_s)) < 1e-6


def vehicle_eigenvalues(p, C_s):
    """Return the eigenvalues of the model with a car body, with the yaw dampers of each bogie against each other."""
    model = Model("power", "reciprocal", (*p, "C_s"))
    return np.append(np.linalg.eigvals(state_matrix(model.at(p, C_s=C_s))), [-p["K_ds"] / C_s] * 2)


def random_vehicles(table1, car_body, n, seed):
    """Return bogies as above, with every number of the car body times or divided by up to 2."""
    rng = np.random.default_rng(seed)
    for p, C_s in random_reciprocal_bogies(table1, n, seed):
        yield {**p, **{name: value * 2.0 ** rng.uniform(-1, 1) for name, value in car_body.items()}}, C_s


def test_eigenvalues_of_random_vehicles(table1, car_body):
    for p, C_s in random_vehicles(table1, car_body, 20, seed=3):
        found = WholeVehicle(p, C_s).eigenvalues()
        assert largest_difference(found, vehicle_eigenvalues(p, C_s)) < 1e-6


def test_every_parameter_of_the_car_body_counts(table1, car_body):
    expected = vehicle_eigenvalues({**table1, **car_body}, 1e6)
    for name in car_body:
        changed = WholeVehicle({**table1, **car_body, name: car_body[name] * 1.01}, 1e6).eigenvalues()
        assert largest_difference(changed, expected) > 1e-5, name


def test_every_parameter_counts(table1):
    expected = expected_eigenvalues(table1, 1e6)
    for name in table1:
        changed = Assembly({**table1, name: table1[name] * 1.01}, 1e6).eigenvalues()
        assert largest_difference(changed, expected) > 1e-5, name


def test_the_model_as_printed_is_another_one(table1):
    vehicle = Model(equations="as-printed").at(table1, C_s=1e6)
    printed = np.append(np.linalg.eigvals(state_matrix(vehicle)), -table1["K_ds"] / 1e6)
    assert largest_difference(Assembly(table1, 1e6).eigenvalues(), printed) > 1e-3


def test_motion_after_an_offset_of_the_front_wheelset(table1):
    offset, end = 1e-4, 1.0
    coarse, fine = (Assembly(table1, 1e6).swing("w1", offset, end, steps) for steps in (4000, 8000))
    vehicle = Model().at(table1, C_s=1e6)
    coordinates = vehicle.state_space.coordinates
    start = np.zeros(25)
    start[coordinates.index("y_w1")] = offset
    matrix = state_matrix(vehicle)
    exact = np.array([sl.expm(matrix * t) @ start for t in fine["b"][:, 0]])
    for body in fine:
        # The integrator starts without accelerations, which costs it one order: two step sizes give it back.
        motion = 2 * fine[body] - coarse[body]
        for name, column in (("y", 2), ("phi", 3)):
            expected = exact[:, coordinates.index(f"{name}_{body}")]
            assert motion[:, column] == pytest.approx(expected, abs=3e-4 * np.abs(expected).max())
