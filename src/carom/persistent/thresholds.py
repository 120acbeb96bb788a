"""Thresholds of persistent contact: equations of a stage, modes, springs of contacts, loss in a step."""

EQUATION_ERROR = 1e-13  #: accelerations without forces: error of the equations of a stage
FORCE_ERROR = 1e-5  #: accelerations without forces: an error that asks for no greater forces
DEPENDENT_ERROR = 1e-3  #: accelerations without forces: greatest error of rows that depend on others
LINEAR_SHARE = 1e-6  #: error: that of the linear equations of a round
LINEAR_ERROR = 0.01  #: error that a round may leave: that of its linear equations
SETTLED_SHARE = 1e-9  #: error: the same for an error that no iteration makes less
LOAD_ERROR = 1e-13  #: load: error of a round that is the last
LOAD_PROBE = 1e-3  #: friction that holds a joint: a part of it, for the derivative of its load
#: speed that forces give in a stage: a joint slides, and does not just give way
SLIDE_OF_FORCES = 3.0
LOAD_LEFT = 1e-9  #: load: the same for an error that more rounds do not make less
POSE_SHARE = 1e-4  #: change of velocities by an iteration of a stage: error of forces in the next one
LAST_CHANGE = 1e-14  #: velocities: change by an iteration that is the last
STAGE_CHANGE = 1e-10  #: velocities: after all iterations: a stage that changes by more has no solution
FRICTION_LIMIT = 1.0 - 1e-6  #: greatest friction: less is within the cone; a stage leaves 3e-9 of a line
#: tolerance: for e = 0: what is thrown up by others and falls back does not bounce, but may be thrown
#: again (an elbow that strikes a box on a floor), and each throw changes velocities by its own
PLASTIC_SPEED = 1e-4
DISC_ERROR = 1e-10  #: greatest friction: a force beyond it by more is outside its cone
LEAST_GRIP = 0.01  #: `BREAK_AWAY`: least margin of what sticks by a law, so that round-off is no event
LEAVING_PART = 1e-10  #: acceleration: away from a surface: less is round-off of a point that stays
STAYING_SPEED = 1e-6  #: speed that forces give in a step: away from a surface: with less a point stays
STIFF_SLIP = 1.5  #: speed of slip: change by friction in a step above which its direction is stiff
SLIP_COSINE = 0.5  #: cosine of the angle: least between directions of slip in a step
MOST_BOUNCES = 50  #: 1: bounces with the e of their own speed, before those that a formula adds up
FAR_TURN = 1.0  #: 1: change of the direction of slip, of 60 degrees, that the implicit member does not follow
TURNED = 1e-3  #: 1: change of the direction of slip in a closing step that is no change of friction
STOPPED_SLIP = 1e-3  #: slip at the start: with less at the end the direction is that of the start: it stops
FALLS = 100.0  #: fall through the size: an error of velocity counts so long; what moves slower is at rest
#: W_nn: a point jams at k below this: at 0 its force has no bound, which no step can follow
JAM_MARGIN = 1e-6
EVENT_MARGIN = 1e-5  #: 1: least margin before an event
BREAK_AWAY = 1e-12  #: acceleration: by friction that is a law: less is round-off of stick
EVENT_ERROR = 1e-6  #: acceleration: an event is located to this part
#: acceleration times the length of a step: speed by an event of several points whose time is known no better
JUMP_ERROR = 1e-9
NO_MARGIN = 1e-7  #: acceleration: less counts as zero: those of two bodies have errors of 1e-9
MOTOR_COMPLIANCE = 1e-13  #: effect of a force without joints: with less, joints and motors leave no freedom
MULTIPLE = 1e4  #: correction: greatest multiple: 1e6 kg on 1 kg take 140
REMOVED = 1e-3  #: error: a correction that removes less leaves that of rows that depend on others
REST_SHARE = 1e-4  #: speed: what may be taken for round-off of rest
FREEDOM_ERROR = 1e-6  #: 1: of a trace, which counts freedoms: with masses far apart it is no whole number
IDLE_PIVOT = 0.01  #: greatest diagonal: with no smaller pivot of normal rows nothing is undetermined
PROXIMAL_SPRING = 1e-5  #: compliance of a spring: proximal term of the forces of springs of contacts
STICK_COMPLIANCE = 1e4  #: compliance of pressing: what others hold already needs no friction
#: compliance of pressing times ratio of masses: where one is more than ten times another it is less, because
#: what friction of a light body has to hold of a heavy one takes corrections as many times their own size
STICK_OF_MASSES = 1e5
#: compliance of pressing times the cube of the number of bodies: where they hold each other in a row it bends
#: n^3 times as easily as one turns, which is found by corrections as many times their own size
STICK_OF_BODIES = 8e4
LEAST_STICK = 100.0  #: compliance of pressing: the least of these
SPRING_ERROR = 1e-6  #: displacements of springs: their error
MOTION_LOSS = 1e-6  #: kinetic energy: allowed loss in a step of several bodies
FALL_LOSS = 1e-2  #: energy that a fall of a whole step gains: added to it, but at most `SIZE_LOSS`
SIZE_LOSS = 1e-7  #: m g times the size: which does not grow with the step
EXCHANGE_FACTOR = 1e3  #: energy exchanged in the step: bounds m g times the size of a body that hardly moves
LEAST_WEIGHT = 1e-4  #: m g times the size: added to this bound: it is far above round-off
BODY_LOSS = 2e-8  #: kinetic energy plus m g times the size: allowed loss of one body
CUT_SHARE = 0.01  #: allowed loss: once a step is cut
GROWTH_SHARE = 1.0 / 8.0  #: allowed loss: with less, the next step is twice as long
#: allowed loss: if a shortest step loses more, its length is not the reason: where a force grows without
#: bound (near a jam, or as a rim becomes flat) a time-stepping step replaces it
LOSS_LIMIT = 100.0
SHORTEST_CUT = 1e-4  #: whole step: least step that is cut for its loss, and piece of a step of a crowd
CROWD_REST = 1e3  #: tolerance of rest: greatest residual, or speed from it, of a crowd at rest
SHORTEST_RETRY = 1e-2  #: whole step: least step that is cut for want of a solution
CUT_RESIDUAL = 0.01  #: speed that gravity gives in a step: with more a step is cut, at last replaced
STOP_RESIDUAL = 10.0  #: speed that gravity gives in a step: above it the run stops
FEW_REST = 10.0  #: tolerance of rest: greatest speed of rest from a residual, of a few bodies
