"""Studies of the models. No study imports another; files here, such as `study` and `can_test`, hold
what several of them share.
"""
